// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode: the verbs check, lengths, compensate, verify, explain and their options.
#include <memory>
#include <string>

#include "tools/cli/gcode_job.hpp"
#include "tools/cli/option_checks.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

using Action = int (*)(const GcodeOptions&);

constexpr const char* kNothingIsWritten =
    "to be left out without --map, because it applies to compensated output";

constexpr files::Range kToleranceMm{"mm", 1e-4, 100.0};

/// \throws InputError for a plotter that takes pictures.
void require_gcode(const InputFile& file) {
  const model::PlotterFirmware plotter = load_plotter(file).plotter.set.firmware;
  if (gcode::firmware(plotter).reads_gcode) return;
  refuse(file.name,
         "/set/firmware",
         std::string(model::name(plotter)),
         "a plotter that accepts G-code, \"fluidnc\" or \"marlin\"; this one draws pictures, "
         "accurately once the lines from chaintrue export plotter are typed in");
}

void open_map(Verb verb, GcodeOptions& options) {
  options.verb = verb;
  Facts facts = facts::no_map;
  if (!options.map.empty()) {
    options.map_file = open_target_file(options.map);
    facts = options.map_file->fact();
    if (facts == facts::plotter) require_gcode(*options.map_file);
  }
  verb.refuse_idle_options(facts);
  options.forced = verb.has_option("--force") && verb.is_given("--force");
}

Verb add(Verb parent,
         const std::shared_ptr<GcodeOptions>& options,
         const char* name,
         const char* help,
         Action action) {
  Verb verb = parent.add_verb(name, help);
  verb.add_option(
      "--home", options->home, "Home on the sheet, X,Y in mm: added to the program's coordinates");
  verb.add_flag(
      "--block-delete", options->skip_deletable, "Leave out lines that begin with a slash");
  verb.add_flag("--tools-have-no-diameter",
                options->tools_have_no_diameter,
                "Ignore G41 and G42, which are refused otherwise");
  verb.add_flag("--home-is-zero",
                options->home_is_zero,
                "G28 and G30 go to the machine's zero, which is the program's");
  add_number(verb,
             "--step-budget",
             options->step_budget,
             {"", 1.0, 1e12},
             "Number of steps in loops and subroutines after which a program counts as endless");
  add_option_check(verb, [options](OptionProblems& problems) {
    problems.take_from([&options] { (void)options->home_mm(); });
  });
  verb.runs(options, [action](Verb chosen, GcodeOptions& own) {
    open_map(chosen, own);
    return action(own);
  });
  return verb;
}

void add_map_options(Verb verb, GcodeOptions& options, bool map_required) {
  const Option map =
      add_input(verb, "--map", options.map, "The compensation map, or the anchors of four belts");
  if (map_required) map.required();
  add_frame_option(verb, options.frame, "Zero of the program: the marks' or the bed's");
}

void add_machine_options(Verb verb, GcodeOptions& options, bool map_required) {
  add_map_options(verb, options, map_required);
  const Option machine = add_input(
      verb,
      "--machine",
      options.machine,
      "A machine file with the controller's settings, if they are not those stored in the map");
  add_input(verb,
            "--settings",
            options.settings,
            "The controller's settings now, if they have changed since the map was measured: "
            "groundcontrol.ini, webcontrol.json, FluidNC's config.yaml, or a machine file")
      .excludes(machine)
      .acts_on(facts::target, "to be left out without --map")
      .acts_on(facts::map | facts::anchors,
               "to be left out; give a plotter's controller settings with --machine, as a "
               "chaintrue_plotter file")
      .acts_on(facts::map,
               "to be left out; give the controller settings of four belts with --machine, as a "
               "belts or anchors file");
  verb.add_option("--controller", options.controller, "Replaces the machine file's")
      .one_of({"maslow_classic", "holey", "fluidnc_wallplotter", "maslow4", "ideal"});
}

void add_limits(Verb verb, GcodeOptions& options) {
  add_number(verb,
             "--tolerance-mm",
             options.tolerance_mm,
             kToleranceMm,
             "Largest permitted error of the tool")
      .acts_on(facts::target, kNothingIsWritten);
  add_number(
      verb, "--decimals", options.decimals, {"", 2.0, 6.0}, "Decimals of the output's coordinates")
      .acts_on(facts::target, kNothingIsWritten);
  add_number(verb,
             "--steepest-correction",
             options.steepest_correction,
             {"mm per mm", 1e-6, 10.0},
             "Refuse corrections that change faster than this [mm/mm]")
      .acts_on(facts::target, kNothingIsWritten);
  verb.add_flag("--keep-rapids-whole", options.keep_rapids_whole, "Correct only the ends of rapids")
      .acts_on(facts::target, kNothingIsWritten);
  add_option_check(verb, [&options](OptionProblems& problems) {
    if (!options.map.empty()) check_limits(options, problems);
  });
}

/// Options refused for compensated programs.
void add_refusals(Verb verb, GcodeOptions& options) {
  add_number(verb,
             "--largest-correction-mm",
             options.largest_correction_mm,
             {"mm", 0.001, 1000.0},
             "Refuse larger corrections")
      .acts_on(facts::target, kNothingIsWritten);
}

}  // namespace

void add_gcode(Verb app) {
  auto options = std::make_shared<GcodeOptions>();
  Verb gcode =
      app.add_verb("gcode", "Check, explain and compensate G-code; chain lengths along its path");
  gcode.require_verb();

  Verb check = add(gcode,
                   options,
                   "check",
                   "List what the program does and what would go wrong, by line",
                   run_gcode_check);
  add_input(check, "file", options->program, "G-code; - is standard input").required();
  add_machine_options(check, *options, false);
  add_limits(check, *options);
  add_refusals(check, *options);
  check.add_flag("--json", options->json, "Print JSON instead of text");
  check.footer(
      "Example:\n"
      "  build/chaintrue gcode check fixtures/gcode/bracket.nc");

  Verb lengths =
      add(gcode, options, "lengths", "Print the chain lengths along the path", run_gcode_lengths);
  add_input(lengths, "file", options->program, "G-code; - is standard input").required();
  add_map_options(lengths, *options, true);
  add_output(lengths, "-o,--output", options->output, {Origin::table}, "CSV; - is standard output")
      .shows_default();
  add_number(lengths,
             "--every-mm",
             options->every_mm,
             {"mm", 1e-9, 1e5},
             "Largest distance between places along a move");
  lengths.add_flag("--json", options->json, "Print one JSON object per line instead of CSV");
  lengths.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue gcode lengths fixtures/gcode/bracket.nc --map map.json -o lengths.csv");

  Verb compensate = add(gcode,
                        options,
                        "compensate",
                        "Rewrite a program so that the tool follows its coordinates",
                        run_gcode_compensate);
  add_input(compensate, "file", options->program, "G-code; - is standard input").required();
  add_machine_options(compensate, *options, true);
  add_output(compensate,
             "-o,--output",
             options->output,
             {Origin::program},
             "The compensated program; - is standard output")
      .required();
  add_output(compensate,
             "--report",
             options->report,
             {Origin::page},
             "Write a page with the path before and after, coloured by the correction");
  add_limits(compensate, *options);
  add_refusals(compensate, *options);
  compensate.add_flag("--no-verify",
                      options->no_verify,
                      "Do not run the output on the simulated machine before it is written");
  compensate.add_flag("--json",
                      options->json,
                      "Print the result as JSON, with each piece of the path: line, 1 for a rapid, "
                      "start and end, correction at both (x, y, mm)");
  compensate.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue gcode compensate fixtures/gcode/bracket.nc --map map.json -o "
      "bracket.true.nc");

  Verb verify = add(
      gcode,
      options,
      "verify",
      "Run a program on a simulated controller and machine; exit code 1 if the tool strays too far",
      run_gcode_verify);
  add_input(verify, "original", options->program, "The program with the intended path").required();
  add_input(verify, "run", options->other, "The program that the controller runs").required();
  add_machine_options(verify, *options, true);
  add_limits(verify, *options);
  verify.add_flag("--json", options->json, "Print JSON instead of text");
  verify.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue gcode compensate fixtures/gcode/bracket.nc --map map.json -o "
      "bracket.true.nc\n"
      "  build/chaintrue gcode verify fixtures/gcode/bracket.nc bracket.true.nc --map map.json");

  Verb explain = add(gcode,
                     options,
                     "explain",
                     "Print the state before and after a line, its moves and their corrections",
                     run_gcode_explain);
  explain.add_option("place", options->program, "FILE:LINE").required();
  add_machine_options(explain, *options, false);
  for (const char* name : {"--machine", "--controller"})
    explain.option(name).acts_on(facts::target, "to be left out without --map");
  explain.footer(
      "Example:\n"
      "  build/chaintrue gcode explain fixtures/gcode/bracket.nc:12");
}

}  // namespace chaintrue::cli
