// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode: the verbs check, lengths, compensate, verify, explain and their options.
#include <memory>
#include <string>

#include "tools/cli/gcode_job.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

constexpr const char* kNothingIsWritten =
    "to be left out without --map, because it applies to compensated output";

constexpr Range kToleranceMm{"mm", 1e-4, 100.0};

/// \throws InputError for a plotter that takes pictures.
void require_gcode(const InputFile& file) {
  const PlotterFirmware plotter = load_plotter(file).plotter.set.firmware;
  if (gcode::firmware(plotter).reads_gcode) return;
  refuse(file.name, "/set/firmware", std::string(name(plotter)),
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
  options.forced = verb.is_given("--force");
}

void check_home(const GcodeOptions& options, OptionProblems& problems) {
  problems.take_from([&options] { (void)options.home_mm(); });
}

Verb add(Verb parent, const std::shared_ptr<GcodeOptions>& options, const char* name,
         const char* help, const char* footer, GcodeVerb* action) {
  Verb verb = parent.add_verb(name, help, footer);
  GcodeOptions& c = *options;
  verb.has(
      {{"--home", without_default(c.home),
        "Home on the sheet, X,Y in mm: added to the program's coordinates"},
       {"--block-delete", c.words.skip_deletable_blocks, "Leave out lines that begin with a slash"},
       {"--tools-have-no-diameter", c.words.tools_have_no_diameter,
        "Ignore G41 and G42, which are refused otherwise"},
       {"--home-is-zero", c.words.home_is_zero,
        "G28 and G30 go to the machine's zero, which is the program's"},
       {"--step-budget",
        {c.words.step_budget, {"", 1.0, 1e12}},
        "Number of steps in loops and subroutines after which a program counts as endless"}});
  add_option_check(verb, c, check_home);
  verb.runs(options, [action](Verb chosen, GcodeOptions& own) {
    open_map(chosen, own);
    return action(own);
  });
  return verb;
}

/// \param map the options' map, as it is read
void add_map_options(Verb verb, GcodeOptions& options, Value map) {
  verb.has({{"--map", std::move(map), "The compensation map, or the anchors of four belts"},
            frame_row(options.frame, "Zero of the program: the marks' or the bed's")});
}

void add_machine_options(Verb verb, GcodeOptions& options, Value map) {
  add_map_options(verb, options, std::move(map));
  verb.has(
      {{"--machine", reads(options.machine),
        "A machine file with the controller's settings, if they are not those stored in the map"},
       {"--settings",
        reads(options.settings),
        "The controller's settings now, if they have changed since the map was measured: "
        "groundcontrol.ini, webcontrol.json, FluidNC's config.yaml, or a machine file",
        facts::target,
        "to be left out without --map",
        {{facts::map | facts::anchors,
          "to be left out; give a plotter's controller settings with --machine, as a "
          "chaintrue_plotter file"},
         {facts::map,
          "to be left out; give the controller settings of four belts with --machine, as a "
          "belts or anchors file"}}},
       {"--controller",
        {options.controller,
         {"maslow_classic", "holey", "fluidnc_wallplotter", "maslow4", "ideal"}},
        "Replaces the machine file's"}});
  verb.excludes({"--settings"}, "--machine");
}

void add_limits(Verb verb, GcodeOptions& options) {
  verb.has({{"--tolerance-mm",
             {options.limits.tolerance_mm, kToleranceMm},
             "Largest permitted error of the tool",
             facts::target,
             kNothingIsWritten},
            {"--decimals",
             {options.limits.decimals, {"", 2.0, 6.0}},
             "Decimals of the output's coordinates",
             facts::target,
             kNothingIsWritten},
            {"--steepest-correction",
             {options.limits.steepest_correction, {"mm per mm", 1e-6, 10.0}},
             "Refuse corrections that change faster than this [mm/mm]",
             facts::target,
             kNothingIsWritten},
            {"--keep-rapids-whole", options.limits.keep_rapids_whole,
             "Correct only the ends of rapids", facts::target, kNothingIsWritten}});
  add_option_check(verb, options, check_limits);
}

OptionRow program_row(GcodeOptions& options) {
  return {"file", required(reads(options.program)), "G-code; - is standard input"};
}

OptionRow largest_correction_row(GcodeOptions& options) {
  return {"--largest-correction-mm",
          {options.limits.largest_correction_mm, {"mm", 0.001, 1000.0}},
          "Refuse larger corrections",
          facts::target,
          kNothingIsWritten};
}

}  // namespace

void add_gcode(Verb app) {
  const auto options = std::make_shared<GcodeOptions>();
  GcodeOptions& c = *options;
  Verb gcode =
      app.add_verb("gcode", "Check, explain and compensate G-code; chain lengths along its path");
  gcode.require_verb();

  Verb check =
      add(gcode, options, "check", "List what the program does and what would go wrong, by line",
          R"(Example:
  build/chaintrue gcode check fixtures/gcode/bracket.nc)",
          run_gcode_check);
  check.has({program_row(c)});
  add_machine_options(check, c, reads(c.map));
  add_limits(check, c);
  check.has({largest_correction_row(c), {"--json", c.json, "Print JSON instead of text"}});

  Verb lengths = add(gcode, options, "lengths", "Print the chain lengths along the path",
                     R"(Example:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue gcode lengths fixtures/gcode/bracket.nc --map map.json -o lengths.csv)",
                     run_gcode_lengths);
  lengths.has({program_row(c)});
  add_map_options(lengths, c, required(reads(c.map)));
  lengths.has({{"-o,--output", writes(c.output, {Origin::table}), "CSV; - is standard output"},
               {"--every-mm",
                {c.every_mm, {"mm", 1e-9, 1e5}},
                "Largest distance between places along a move"},
               {"--json", c.json, "Print one JSON object per line instead of CSV"}});

  Verb compensate = add(gcode, options, "compensate",
                        "Rewrite a program so that the tool follows its coordinates",
                        R"(Example:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue gcode compensate fixtures/gcode/bracket.nc --map map.json -o bracket.true.nc)",
                        run_gcode_compensate);
  compensate.has({program_row(c)});
  add_machine_options(compensate, c, required(reads(c.map)));
  compensate.has({{"-o,--output", required(writes(c.output, {Origin::program})),
                   "The compensated program; - is standard output"},
                  {"--report", writes(c.report, {Origin::page}),
                   "Write a page with the path before and after, coloured by the correction"}});
  add_limits(compensate, c);
  compensate.has({largest_correction_row(c),
                  {"--no-verify", c.no_verify,
                   "Do not run the output on the simulated machine before it is written"},
                  {"--json", c.json,
                   "Print the result as JSON, with each piece of the path: line, 1 for a rapid, "
                   "start and end, correction at both (x, y, mm)"}});

  Verb verify = add(
      gcode, options, "verify",
      "Run a program on a simulated controller and machine; exit code 1 if the tool strays too far",
      R"(Example:
  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json
  build/chaintrue gcode compensate fixtures/gcode/bracket.nc --map map.json -o bracket.true.nc
  build/chaintrue gcode verify fixtures/gcode/bracket.nc bracket.true.nc --map map.json)",
      run_gcode_verify);
  verify.has({{"original", required(reads(c.program)), "The program with the intended path"},
              {"run", required(reads(c.other)), "The program that the controller runs"}});
  add_machine_options(verify, c, required(reads(c.map)));
  add_limits(verify, c);
  verify.has({{"--json", c.json, "Print JSON instead of text"}});

  Verb explain = add(gcode, options, "explain",
                     "Print the state before and after a line, its moves and their corrections",
                     R"(Example:
  build/chaintrue gcode explain fixtures/gcode/bracket.nc:12)",
                     run_gcode_explain);
  explain.has({{"place", required(c.program), "FILE:LINE"}});
  add_machine_options(explain, c, reads(c.map));
  for (const char* name : {"--machine", "--controller"})
    explain.acts_on(name, {{facts::target, "to be left out without --map"}});
}

}  // namespace chaintrue::cli
