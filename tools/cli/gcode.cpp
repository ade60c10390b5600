// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode: check, lengths, compensate, verify, explain.
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <cstdio>
#include <functional>
#include <iterator>
#include <memory>
#include <string>

#include "grid/files/input_error.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/gcode_job.hpp"
#include "tools/gcode/path_lengths.hpp"
#include "tools/gcode/survey.hpp"
#include "tools/gcode/verifier.hpp"
#include "tools/report/path_report.hpp"

namespace chaintrue::cli {
namespace {

using gcode::Findings;

gcode::CompensateOptions compensate_options(const GcodeOptions& options,
                                            const GcodeMachine& machine) {
  gcode::CompensateOptions result;
  result.tolerance_mm = options.tolerance_mm;
  result.decimals = options.decimals;
  result.home = options.home_mm();
  result.largest_correction_mm = options.largest_correction_mm;
  result.steepest_correction = options.steepest_correction;
  result.keep_rapids_whole = options.keep_rapids_whole;
  result.home_is_zero = options.home_is_zero;
  result.clamp_box = gcode::clamp_box(machine.machine());
  result.half_play_mm = machine.half_play_mm();
  result.map_hash = machine.map_hash();
  return result;
}

gcode::BedRectangle sheet(const GcodeOptions& options) {
  const model::Bed bed =
      options.machine.empty() ? model::Bed{} : grid::files::read_machine(options.machine).bed;
  return {-0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
}

void print_survey(const gcode::Survey& survey, bool json) {
  const gcode::Box box = survey.box.value_or(gcode::Box{});
  const double slowest = survey.slowest_mm_per_min.value_or(0.0);
  const double fastest = survey.fastest_mm_per_min.value_or(0.0);
  if (json) {
    fmt::print(
        "{{\"lines\": {}, \"rapids\": {}, \"feeds\": {}, \"arcs\": {}, \"probes\": {}, "
        "\"path_mm\": {:.3f}, "
        "\"x_mm\": [{:.3f}, {:.3f}], \"y_mm\": [{:.3f}, {:.3f}], \"z_mm\": [{:.3f}, {:.3f}], "
        "\"feed_mm_per_min\": [{:.3f}, {:.3f}]}}\n",
        survey.program.lines,
        survey.rapids,
        survey.feeds,
        survey.arcs,
        survey.probes,
        survey.path_mm,
        box.least.x_mm,
        box.most.x_mm,
        box.least.y_mm,
        box.most.y_mm,
        box.least.z_mm,
        box.most.z_mm,
        slowest,
        fastest);
    return;
  }
  fmt::print("{} lines: {} rapids, {} straight cuts, {} arcs; {:.1f} m of path\n",
             survey.program.lines,
             survey.rapids,
             survey.feeds,
             survey.arcs,
             survey.path_mm / 1000.0);
  if (!survey.box) {
    fmt::print("the program goes nowhere in X and Y\n");
    return;
  }
  fmt::print("X {:.3f} to {:.3f} mm, Y {:.3f} to {:.3f} mm, Z {:.3f} to {:.3f} mm\n",
             box.least.x_mm,
             box.most.x_mm,
             box.least.y_mm,
             box.most.y_mm,
             box.least.z_mm,
             box.most.z_mm);
  if (survey.slowest_mm_per_min) fmt::print("feed {:.6g} to {:.6g} mm/min\n", slowest, fastest);
}

int run_check(const GcodeOptions& options) {
  const GcodeText text(options.program);
  auto source = text.open();
  Findings findings;
  const auto survey =
      gcode::survey(source, options.dialect(), options.home_mm(), sheet(options), findings);
  if (!survey) {
    report(options.program, findings);
    return report(options.program, survey.error());
  }
  print_survey(*survey, options.json);
  if (options.map.empty()) return report(options.program, findings);
  // With a map: everything that compensating would object to; what it would write is thrown away.
  const GcodeMachine machine(options);
  gcode::Compensator compensator(
      machine.corrector(), compensate_options(options, machine), [](std::string_view) {});
  auto again = text.open();
  const auto outcome = compensator.run(again, options.dialect());
  int code = report(options.program, compensator.findings());
  for (const gcode::Problem& problem : findings.problems) {
    const int own = report(options.program, problem);
    if (code == kDone) code = own;
  }
  if (!outcome) return report(options.program, outcome.error());
  if (!options.json && code == kDone) {
    fmt::print("the largest correction is {:.2f} mm, on line {}\n",
               outcome->largest_correction_mm,
               outcome->largest_correction_line);
  }
  return code;
}

int run_lengths(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  auto source = GcodeText(options.program).open();
  PendingFile output(options.output);
  if (!options.json) {
    output.write(
        "line,kind,x_mm,y_mm,z_mm,left_mm,right_mm,left_sigma_mm,right_sigma_mm,feed_mm_per_min\n");
  }
  std::string row;
  const auto write = [&](const gcode::PathLengths& place) {
    row.clear();
    const auto& [left, right] = place.answer.lengths;
    const auto& [left_sigma, right_sigma] = place.answer.sigma;
    if (options.json) {
      fmt::format_to(std::back_inserter(row),
                     "{{\"line\": {}, \"kind\": \"{}\", \"x_mm\": {:.6f}, \"y_mm\": {:.6f}, "
                     "\"z_mm\": {:.6f}, \"left_mm\": {:.6f}, "
                     "\"right_mm\": {:.6f}, \"left_sigma_mm\": {:.4f}, \"right_sigma_mm\": {:.4f}, "
                     "\"feed_mm_per_min\": {}}}\n",
                     place.line,
                     gcode::name(place.kind),
                     place.place.x_mm,
                     place.place.y_mm,
                     place.place.z_mm,
                     left,
                     right,
                     left_sigma,
                     right_sigma,
                     place.kind == gcode::MoveKind::rapid
                         ? std::string("null")
                         : fmt::format("{:.3f}", place.feed_mm_per_min));
    } else {
      fmt::format_to(std::back_inserter(row),
                     "{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{}\n",
                     place.line,
                     gcode::name(place.kind),
                     place.place.x_mm,
                     place.place.y_mm,
                     place.place.z_mm,
                     left,
                     right,
                     left_sigma,
                     right_sigma,
                     place.kind == gcode::MoveKind::rapid
                         ? std::string()
                         : fmt::format("{:.3f}", place.feed_mm_per_min));
    }
    output.write(row);
  };
  Findings findings;
  const auto outcome = gcode::path_lengths(source,
                                           options.dialect(),
                                           machine.target(),
                                           options.home_mm(),
                                           options.every_mm,
                                           write,
                                           findings);
  if (!outcome) return report(options.program, outcome.error());
  output.commit();
  return report(options.program, findings);
}

int run_compensate(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  const GcodeText text(options.program);
  auto source = text.open();
  gcode::CompensateOptions settings = compensate_options(options, machine);
  settings.input_hash = text.hash();
  report::PathReport picture;
  if (!options.report.empty()) {
    settings.on_command =
        [&picture](const gcode::Move& move, const gcode::Station& from, const gcode::Station& to) {
          const auto correction = [](const gcode::Station& station) {
            return report::ToolVector{station.command.x_mm - station.target.x_mm,
                                      station.command.y_mm - station.target.y_mm};
          };
          picture.add({move.line,
                       move.kind == gcode::MoveKind::rapid,
                       from.target.x_mm,
                       from.target.y_mm,
                       to.target.x_mm,
                       to.target.y_mm,
                       correction(from),
                       correction(to)});
        };
  }
  PendingFile output(options.output);
  gcode::Compensator compensator(
      machine.corrector(), settings, [&](std::string_view bytes) { output.write(bytes); });
  const auto summary = compensator.run(source, options.dialect());
  const int code = report(options.program, compensator.findings());
  if (!summary) return report(options.program, summary.error());
  if (code != kDone) {
    fmt::print(stderr, "nothing is written\n");
    return code;
  }
  output.commit();
  const std::string words = fmt::format(
      "{} blocks, {} moves, {:.1f} m of path: {} commands for {}; largest correction {:.2f} mm on "
      "line {}",
      summary->blocks,
      summary->moves,
      summary->path_mm / 1000.0,
      summary->commands,
      machine.corrector().firmware().name,
      summary->largest_correction_mm,
      summary->largest_correction_line);
  fmt::print(stderr, "{}\n", words);
  if (!options.report.empty()) {
    const model::Bed& bed = machine.machine().bed;
    picture.name = options.program;
    picture.verdict = words + ".";
    picture.sheet = {
        -0.5 * bed.width_mm, 0.5 * bed.width_mm, -0.5 * bed.height_mm, 0.5 * bed.height_mm};
    picture.figures = {
        {fmt::format("{:.2f} mm", summary->largest_correction_mm), "largest correction"},
        {fmt::format("{:g} mm", options.tolerance_mm), "tolerance of the path"},
        {fmt::format("{:.1f} m", summary->path_mm / 1000.0), "path"},
        {fmt::format("{}", summary->commands), "commands written"}};
    grid::files::write_whole_file(options.report, report::render(report::page_of(picture)));
  }
  return kDone;
}

gcode::VerifySummary verified(const GcodeOptions& options,
                              const GcodeMachine& machine,
                              const GcodeText& original,
                              const GcodeText& run,
                              model::BedPoint run_home,
                              int& code) {
  gcode::VerifyOptions settings;
  settings.tolerance_mm = options.tolerance_mm;
  settings.home = options.home_mm();
  settings.run_home = run_home;
  settings.half_play_mm = machine.half_play_mm();
  settings.rapids_whole = options.keep_rapids_whole;
  auto a = original.open();
  auto b = run.open();
  const auto summary = gcode::verify(a, b, machine.corrector(), options.dialect(), settings);
  if (summary) return *summary;
  code = report(summary.error().in_original ? options.program : options.other,
                summary.error().problem);
  return {};
}

std::string worst_in_words(const gcode::VerifySummary& summary) {
  const bool at_feeds = summary.feeds.largest_mm >= summary.rapids.largest_mm;
  const gcode::Deviation& worst = at_feeds ? summary.feeds : summary.rapids;
  return fmt::format(
      "{:.4f} mm from the intended path, at X{:.3f} Y{:.3f} Z{:.3f} (line {} of the original, line "
      "{} of the file run)",
      worst.largest_mm,
      worst.intended.x_mm,
      worst.intended.y_mm,
      worst.intended.z_mm,
      worst.original_line,
      worst.run_line);
}

int run_verify(const GcodeOptions& options) {
  const GcodeMachine machine(options);
  const GcodeText original(options.program);
  const GcodeText other(options.other);
  int code = kDone;
  const auto summary = verified(options, machine, original, other, {}, code);
  if (code != kDone) return code;
  int control_code = kDone;
  const auto control =
      verified(options, machine, original, original, options.home_mm(), control_code);
  const bool holds = summary.largest_mm() <= options.tolerance_mm && summary.words_differ.empty();
  if (options.json) {
    fmt::print(
        "{{\"holds\": {}, \"largest_mm\": {:.6f}, \"feeds_mm\": {:.6f}, \"rapids_mm\": {:.6f}, "
        "\"original_line\": {}, "
        "\"tolerance_mm\": {}, \"uncompensated_mm\": {}, \"tick_overshoot_mm\": {:.6f}, "
        "\"commands\": {}, \"places\": {}}}\n",
        holds,
        summary.largest_mm(),
        summary.feeds.largest_mm,
        summary.rapids.largest_mm,
        summary.feeds.original_line,
        options.tolerance_mm,
        control_code == kDone ? fmt::format("{:.6f}", control.largest_mm()) : "null",
        summary.tick_overshoot_mm,
        summary.commands,
        summary.places);
  } else {
    fmt::print("{}: the tool strays at most {}\n",
               holds ? "holds" : "does not hold",
               worst_in_words(summary));
    fmt::print("tolerance {} mm, {} commands, {} places compared, controller {}\n",
               options.tolerance_mm,
               summary.commands,
               summary.places,
               machine.corrector().firmware().name);
    if (control_code == kDone) fmt::print("without compensation: {}\n", worst_in_words(control));
    if (summary.tick_overshoot_mm > 0.0) {
      fmt::print(
          "the controller's last tick overshoots a command's end by up to {:.3f} mm and comes "
          "back, as in every file\n",
          summary.tick_overshoot_mm);
    }
    if (!summary.words_differ.empty())
      fmt::print("the words that pass through differ: {}\n", summary.words_differ);
  }
  return holds ? kDone : kCheckFailed;
}

/// Keeps what one line does.
struct LineEvents final : gcode::Sink {
  gcode::Result<void> move(const gcode::Move& move) override {
    if (listening) moves.push_back(move);
    return {};
  }
  gcode::Result<void> word(const gcode::PassedWord& word) override {
    if (listening) words += fmt::format(" {}", word.text);
    return {};
  }
  bool listening = false;
  std::vector<gcode::Move> moves;
  std::string words;
};

void explain_move(const gcode::Move& move, model::BedPoint home, const GcodeMachine* machine) {
  const model::BedPoint target{move.to.x_mm + home.x_mm, move.to.y_mm + home.y_mm};
  fmt::print("  {} to X{:.4f} Y{:.4f} Z{:.4f} mm on the sheet, {:.4f} mm long\n",
             gcode::name(move.kind),
             target.x_mm,
             target.y_mm,
             move.to.z_mm,
             gcode::length_mm(move));
  if (move.arc) {
    fmt::print("    centre X{:.4f} Y{:.4f}, radius {:.4f} mm, {:.4f} degrees\n",
               move.arc->centre.x_mm + home.x_mm,
               move.arc->centre.y_mm + home.y_mm,
               move.arc->start_radius_mm,
               move.arc->sweep_rad * 57.29577951308232);
  }
  if (machine == nullptr) return;
  const auto answer = machine->target().query(target);
  const auto command = machine->corrector().command(target);
  if (!answer || !command) {
    fmt::print("    {}\n",
               answer ? gcode::explain(command.error()) : gcode::explain(answer.error()));
    return;
  }
  fmt::print("    chains: left {:.4f} mm (sigma {:.3f}), right {:.4f} mm (sigma {:.3f})\n",
             answer->lengths.left_mm,
             answer->sigma.left_mm,
             answer->lengths.right_mm,
             answer->sigma.right_mm);
  fmt::print("    command for {}: X{:.4f} Y{:.4f}, corrected by X{:+.4f} Y{:+.4f} mm\n",
             machine->corrector().firmware().name,
             command->x_mm,
             command->y_mm,
             command->x_mm - target.x_mm,
             command->y_mm - target.y_mm);
}

int run_explain(const GcodeOptions& options) {
  const std::size_t colon = options.program.rfind(':');
  std::size_t line = 0;
  const char* begin = options.program.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* end = options.program.data() + options.program.size();
  if (colon == std::string::npos || std::from_chars(begin, end, line).ptr != end || line == 0) {
    throw grid::files::InputError(
        {{"explain", "", options.program, "a file and a line, such as part.nc:12"}});
  }
  const std::string file = options.program.substr(0, colon);
  std::unique_ptr<GcodeMachine> machine;
  if (!options.map.empty()) machine = std::make_unique<GcodeMachine>(options);
  auto source = GcodeText(file).open();
  LineEvents events;
  gcode::Program program(source, options.dialect(), events);
  const auto print_state = [&](const char* title) {
    fmt::print("{}\n", title);
    for (const std::string& text : program.interpreter().describe()) fmt::print("  {}\n", text);
  };
  while (program.next_line() != line) {
    const auto more = program.step();
    if (!more) return report(file, more.error());
    if (!*more)
      return report(
          file,
          gcode::Problem{
              gcode::ProblemName::bad_flow, {line, 0}, "the program never comes to this line"});
  }
  print_state("before:");
  events.listening = true;
  const auto more = program.step();
  if (!more) return report(file, more.error());
  fmt::print("line {}:{}\n", line, events.words.empty() ? "" : " passes" + events.words);
  for (const gcode::Move& move : events.moves) explain_move(move, options.home_mm(), machine.get());
  print_state("after:");
  return kDone;
}

using Action = int (*)(const GcodeOptions&);

/// Above zero, in the unit that the option's name carries.
CLI::Validator positive() {
  return CLI::Validator(
      [](std::string& text) {
        double value = 0.0;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const bool good = error == std::errc{} && end == text.data() + text.size() &&
                          std::isfinite(value) && value > 0.0;
        return good ? std::string() : "expected a number above zero, found " + text;
      },
      "> 0");
}

CLI::App* add(CLI::App& parent,
              Run& run,
              const std::shared_ptr<GcodeOptions>& options,
              const char* name,
              const char* help,
              Action action) {
  CLI::App* verb = parent.add_subcommand(name, help);
  verb->add_option(
      "--home",
      options->home,
      "X,Y in mm that is added to the program's coordinates to get those of the sheet");
  verb->add_flag(
      "--block-delete", options->skip_deletable, "Leave out lines that begin with a slash");
  verb->add_flag("--tools-have-no-diameter",
                 options->tools_have_no_diameter,
                 "G41 and G42 change nothing; otherwise they are refused");
  verb->add_option("--step-budget",
                   options->step_budget,
                   "Steps in loops and subroutines until a program counts as endless")
      ->capture_default_str();
  verb->callback([options, action, &run] { run = [options, action] { return action(*options); }; });
  return verb;
}

void add_machine_options(CLI::App& verb, GcodeOptions& options, bool map_required) {
  auto* map = verb.add_option("--map", options.map, "The compensation map");
  if (map_required) map->required();
  verb.add_option(
      "--machine",
      options.machine,
      "A machine file: what the controller believes, if not the map's machine as it was stated");
  verb.add_option("--controller", options.controller, "In place of the machine file's")
      ->check(CLI::IsMember({"maslow_classic", "holey", "fluidnc_wallplotter", "ideal"}));
  verb.add_option("--frame", options.frame, "The program's zero: the marks' or the bed's")
      ->check(CLI::IsMember({"marks", "bed"}))
      ->capture_default_str();
}

void add_limits(CLI::App& verb, GcodeOptions& options) {
  verb.add_option("--tolerance-mm", options.tolerance_mm, "How far the tool may stray")
      ->check(positive())
      ->capture_default_str();
  verb.add_option("--decimals", options.decimals, "Of the output's coordinates")
      ->check(CLI::Range(2, 6))
      ->capture_default_str();
  verb.add_option("--largest-correction-mm", options.largest_correction_mm, "Refuse larger ones")
      ->check(positive())
      ->capture_default_str();
  verb.add_option("--steepest-correction",
                  options.steepest_correction,
                  "Refuse changes above this, in mm per mm")
      ->check(positive())
      ->capture_default_str();
  verb.add_flag(
      "--keep-rapids-whole", options.keep_rapids_whole, "Only the ends of rapids are made true");
  verb.add_flag("--home-is-zero",
                options.home_is_zero,
                "G28 and G30 go to the machine's zero; otherwise they are refused");
}

}  // namespace

void add_gcode(CLI::App& app, Run& run) {
  auto options = std::make_shared<GcodeOptions>();
  CLI::App* gcode = app.add_subcommand(
      "gcode", "Check, explain and compensate G-code; chain lengths along its path");
  gcode->require_subcommand(1);

  CLI::App* check = add(*gcode,
                        run,
                        options,
                        "check",
                        "What the program does, and what would go wrong, by line",
                        run_check);
  check->add_option("file", options->program, "G-code; - is standard input")->required();
  add_machine_options(*check, *options, false);
  add_limits(*check, *options);
  check->add_flag("--json", options->json, "JSON in place of words");
  check->footer(
      "Example:\n"
      "  build/chaintrue gcode check fixtures/gcode/bracket.nc");

  CLI::App* lengths =
      add(*gcode, run, options, "lengths", "The chain lengths along the path", run_lengths);
  lengths->add_option("file", options->program, "G-code; - is standard input")->required();
  add_machine_options(*lengths, *options, true);
  lengths->add_option("-o,--output", options->output, "CSV; - is standard output")
      ->capture_default_str();
  lengths
      ->add_option("--every-mm", options->every_mm, "Places along a move are at most so far apart")
      ->check(positive())
      ->capture_default_str();
  lengths->add_flag("--json", options->json, "One JSON object a line in place of CSV");
  lengths->footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue gcode lengths fixtures/gcode/bracket.nc --map map.json -o lengths.csv");

  CLI::App* compensate = add(*gcode,
                             run,
                             options,
                             "compensate",
                             "Rewrite a program so that the tool goes where it says",
                             run_compensate);
  compensate->add_option("file", options->program, "G-code; - is standard input")->required();
  add_machine_options(*compensate, *options, true);
  compensate
      ->add_option("-o,--output", options->output, "The compensated program; - is standard output")
      ->required();
  compensate->add_option("--report",
                         options->report,
                         "A page with the path before and after, coloured by the correction");
  add_limits(*compensate, *options);
  compensate->footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue gcode compensate fixtures/gcode/bracket.nc --map map.json -o "
      "bracket.true.nc");

  CLI::App* verify =
      add(*gcode,
          run,
          options,
          "verify",
          "Run a program on a simulated controller and machine; exit code 1 when the tool strays",
          run_verify);
  verify->add_option("original", options->program, "Where the tool shall go")->required();
  verify->add_option("run", options->other, "What the controller is given")->required();
  add_machine_options(*verify, *options, true);
  add_limits(*verify, *options);
  verify->add_flag("--json", options->json, "JSON in place of words");
  verify->footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/grids/seven_by_four.json -o map.json\n"
      "  build/chaintrue gcode compensate fixtures/gcode/bracket.nc --map map.json -o "
      "bracket.true.nc\n"
      "  build/chaintrue gcode verify fixtures/gcode/bracket.nc bracket.true.nc --map map.json");

  CLI::App* explain = add(*gcode,
                          run,
                          options,
                          "explain",
                          "State before and after a line, its moves and their corrections",
                          run_explain);
  explain->add_option("place", options->program, "FILE:LINE")->required();
  add_machine_options(*explain, *options, false);
  explain->footer(
      "Example:\n"
      "  build/chaintrue gcode explain fixtures/gcode/bracket.nc:12");
}

}  // namespace chaintrue::cli
