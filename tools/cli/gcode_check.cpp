// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode check and lengths: what a program does, without changing it.
#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <memory>
#include <string>
#include <vector>

#include "tools/cli/gcode_job.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/gcode/controller_check.hpp"
#include "tools/gcode/reports.hpp"

namespace chaintrue::cli {

namespace {

void print_survey(const gcode::Survey& survey, bool json) {
  end_progress();
  const gcode::Box box = survey.box.value_or(gcode::Box{});
  const double slowest = survey.slowest_mm_per_min.value_or(0.0);
  const double fastest = survey.fastest_mm_per_min.value_or(0.0);
  if (json) {
    fmt::print(
        "{{\"lines\": {}, \"rapids\": {}, \"feeds\": {}, \"arcs\": {}, \"probes\": {}, "
        "\"path_mm\": {:.3f}, \"x_mm\": [{:.3f}, {:.3f}], \"y_mm\": [{:.3f}, {:.3f}], \"z_mm\": "
        "[{:.3f}, {:.3f}], \"feed_mm_per_min\": [{:.3f}, {:.3f}]}}\n",
        survey.program.lines, survey.rapids, survey.feeds, survey.arcs, survey.probes,
        survey.path_mm, box.least.x_mm, box.most.x_mm, box.least.y_mm, box.most.y_mm,
        box.least.z_mm, box.most.z_mm, slowest, fastest);
    return;
  }
  fmt::print("{} lines: {} rapids, {} straight cuts, {} arcs; {:.1f} m of path\n",
             survey.program.lines, survey.rapids, survey.feeds, survey.arcs,
             survey.path_mm / 1000.0);
  if (!survey.box) {
    fmt::print("the program does not move in X or Y\n");
    return;
  }
  fmt::print("X {:.3f} to {:.3f} mm, Y {:.3f} to {:.3f} mm, Z {:.3f} to {:.3f} mm\n",
             box.least.x_mm, box.most.x_mm, box.least.y_mm, box.most.y_mm, box.least.z_mm,
             box.most.z_mm);
  if (survey.slowest_mm_per_min) fmt::print("feed {:.6g} to {:.6g} mm/min\n", slowest, fastest);
}

/// Largest useful table of lengths: 2 GB.
constexpr double kMostRows = 2e7;

/// About how many rows the table will have. \throws InputError if it would be longer; a program
/// that cannot be read to its end has none; its problem is reported elsewhere.
double rows_of_lengths(const GcodeOptions& options, const GcodeText& text) {
  auto source = text.open({"the length of the path", 1, 2});
  Findings ignored;
  const auto survey = gcode::survey(source, options.dialect(), {}, ignored);
  if (!survey) return 0.0;
  const double rows = survey->path_mm / options.every_mm;
  if (rows <= kMostRows) return rows;
  refuse("command line", "--every-mm", fmt::format("{}", options.every_mm),
         fmt::format("at least {:.2g} mm: {:.1f} m of path would give {:.1e} rows, about {:.0f} GB",
                     survey->path_mm / kMostRows, survey->path_mm / 1000.0, rows, rows * 1e-7));
}

/// The program next to the compensated one, or its first line in words.
void say_next_of_program(const GcodeOptions& options) {
  if (options.map.empty()) {
    if (options.program != "-") say_next({"gcode", "explain", options.program + ":1"});
    return;
  }
  Words next = with_map_words(options, {"gcode", "compensate", options.program});
  add_option_words(next, "-o", options.program == "-" ? "-" : compensated_name(options.program));
  say_next(next);
}

/// With a map: all problems that compensating would report; its output is discarded. \param found
/// by the survey
int check_compensation(const GcodeMachine& machine, const GcodeOptions& options, LineSource source,
                       const gcode::Survey& survey, const Findings& found) {
  CompensateOptions settings = compensate_options(options, machine);
  gcode::CutPlaces cuts;
  settings.on_command = [&cuts](const Move& move, const PathSample& from, const PathSample& to) {
    if (move.kind != gcode::MoveKind::rapid) cuts.add(move.line, from.target, to.target);
  };
  gcode::Compensator compensator(machine.corrector, settings, [](std::string_view) {});
  const auto outcome = compensator.run(source, options.dialect());
  print_survey(survey, options.json);
  int code = report(options.program, compensator.findings());
  for (const Problem& problem : found.problems) {
    if (problem.name != gcode::ProblemName::outside_sheet) continue;  // the others are among these
    const int own = report(options.program, problem);
    if (code == kDone) code = own;
  }
  if (!outcome) return report(options.program, outcome.error());
  if (options.json || code != kDone) return code;
  fmt::print("the largest correction is {:.2f} mm, on line {}\n", outcome->largest_correction_mm,
             outcome->largest_correction_line);
  // The error of a two-chain map is reported by fit; that of anchors only along cuts.
  if (machine.target.as<CompensationMap>() == nullptr)
    fmt::print("{}", in_words(promised_along(cuts, machine, options.limits.tolerance_mm)));
  return code;
}

/// Null without a map.
std::unique_ptr<const GcodeMachine> machine_if_any(const GcodeOptions& options) {
  return options.map.empty() ? nullptr : std::make_unique<const GcodeMachine>(options);
}

}  // namespace

int run_gcode_check(const GcodeOptions& options) {
  const auto machine = machine_if_any(options);
  const GcodeText text(options.program);
  const Firmware* firmware = stated_firmware(options.controller);
  const int steps = 1 + (firmware != nullptr ? 1 : 0) + (options.map.empty() ? 0 : 1);
  auto source = text.open({"the program", 1, steps});
  Findings findings;
  const gcode::Sheet sheet = machine == nullptr
                                 ? gcode::Sheet{sheet_of(options), options.machine.empty()}
                                 : gcode::Sheet{machine->controller.sheet};
  const auto survey = gcode::survey(source, options.dialect(), sheet, findings);
  if (!survey) {
    report(options.program, findings);
    return report(options.program, survey.error());
  }
  if (firmware != nullptr) {
    gcode::ControllerCheck check(*firmware, findings);
    auto once_more = text.open({"the controller's interpretation", 2, steps});
    const auto outcome = run_program(once_more, options.dialect(), check);
    if (!outcome) return report(options.program, outcome.error());
  }
  int code = kDone;
  if (machine == nullptr) {
    print_survey(*survey, options.json);
    code = report(options.program, findings);
  } else {
    code = check_compensation(*machine, options, text.open({"its compensation", steps, steps}),
                              *survey, findings);
  }
  if (code == kDone) say_next_of_program(options);
  return code;
}

int run_gcode_lengths(const GcodeOptions& options) {
  const Target target = open_target(options);
  const GcodeText text(options.program);
  const double rows = rows_of_lengths(options, text);
  auto source = text.open();
  shown_progress()({"chain lengths", 2, 2});
  PendingFile output(options.output);
  if (!options.json) {
    output.write(
        "line,kind,x_mm,y_mm,z_mm,left_mm,right_mm,left_sigma_mm,right_sigma_mm,feed_mm_per_min\n");
  }
  const std::string_view row =
      options.json ? "{{\"line\": {}, \"kind\": \"{}\", \"x_mm\": {:.6f}, \"y_mm\": {:.6f}, "
                     "\"z_mm\": {:.6f}, \"left_mm\": {:.6f}, \"right_mm\": {:.6f}, "
                     "\"left_sigma_mm\": {:.4f}, \"right_sigma_mm\": {:.4f}, "
                     "\"feed_mm_per_min\": {}}}\n"
                   : "{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{}\n";
  const std::string_view no_feed = options.json ? "null" : "";
  double written = 0.0;
  const auto write = [&](const gcode::PathLengths& place) {
    progress_is(std::min(++written, rows), rows);
    output.write(fmt::format(
        fmt::runtime(row), place.line, name(place.kind), place.place.x_mm, place.place.y_mm,
        place.place.z_mm, place.answer.lengths_mm[0], place.answer.lengths_mm[1],
        place.answer.sigma.left_mm, place.answer.sigma.right_mm,
        place.kind == gcode::MoveKind::rapid ? std::string(no_feed)
                                             : fmt::format("{:.3f}", place.feed_mm_per_min)));
  };
  Findings findings;
  const auto outcome =
      path_lengths(source, options.dialect(), *target.lengths, options.every_mm, write, findings);
  if (!outcome) return report(options.program, outcome.error());
  const int code = report(options.program, findings);
  if (code != kDone) {
    say("nothing is written");
    return code;
  }
  take_place(output, options.output, {});
  say_next_of_program(options);
  return code;
}

// chaintrue gcode explain.
namespace {

/// Stores the actions of one line.
struct LineEvents final : gcode::Sink {
  void move(const Move& move) override {
    if (listening) moves.push_back(move);
  }
  void word(const gcode::PassedWord& word) override {
    if (listening) words += fmt::format(" {}", word.text);
  }
  bool listening = false;
  std::vector<Move> moves;
  std::string words;
};

/// `machine` is null without a map.
void explain_move(const Move& move, const GcodeMachine* machine) {
  const BedPoint target{move.to.x_mm, move.to.y_mm};
  fmt::print("  {} to X{:.4f} Y{:.4f} Z{:.4f} mm on the sheet, {:.4f} mm long\n", name(move.kind),
             target.x_mm, target.y_mm, move.to.z_mm, length_mm(move));
  if (move.arc) {
    fmt::print("    centre X{:.4f} Y{:.4f}, radius {:.4f} mm, {:.4f} degrees\n",
               move.arc->centre.x_mm, move.arc->centre.y_mm, move.arc->start_radius_mm,
               move.arc->sweep_rad * 57.29577951308232);
  }
  if (machine == nullptr) return;
  const auto answer = machine->target.lengths->query(target);
  const auto command = machine->corrector.command(target);
  if (!answer || !command) {
    fmt::print("    {}\n", answer ? command.error().sentence() : answer.error().sentence());
    return;
  }
  fmt::print("    chains: left {:.4f} mm (sigma {:.3f}), right {:.4f} mm (sigma {:.3f})\n",
             answer->lengths_mm[0], answer->sigma.left_mm, answer->lengths_mm[1],
             answer->sigma.right_mm);
  fmt::print("    command for {}: X{:.4f} Y{:.4f}, corrected by X{:+.4f} Y{:+.4f} mm\n",
             machine->corrector.firmware().name, command->x_mm, command->y_mm,
             command->x_mm - target.x_mm, command->y_mm - target.y_mm);
}

}  // namespace

int run_gcode_explain(const GcodeOptions& options) {
  const auto machine = machine_if_any(options);
  const std::size_t colon = options.program.rfind(':');
  std::size_t line = 0;
  const char* begin = options.program.data() + (colon == std::string::npos ? 0 : colon + 1);
  const char* end = options.program.data() + options.program.size();
  if (colon == std::string::npos || std::from_chars(begin, end, line).ptr != end || line == 0) {
    refuse("explain", options.program, "a file and a line, such as part.nc:12");
  }
  const std::string file = options.program.substr(0, colon);
  const GcodeText text(file);
  auto source = text.open({"the program up to that line"});
  LineEvents events;
  gcode::Program program(source, options.dialect(), events);
  const auto print_state = [&](const char* title) {
    fmt::print("{}\n", title);
    for (const std::string& words : program.interpreter().describe()) fmt::print("  {}\n", words);
  };
  const auto before = gcode::attempt([&] {
    while (program.next_line() != line) {
      if (!program.step())
        refuse(gcode::ProblemName::bad_flow, {line, 0}, "the program never reaches this line");
    }
    return line;
  });
  if (!before) return report(file, before.error());
  print_state("before:");
  events.listening = true;
  const auto done = gcode::attempt([&] { return program.step(); });
  if (!done) return report(file, done.error());
  fmt::print("line {}:{}\n", line, events.words.empty() ? "" : " passes" + events.words);
  for (const Move& move : events.moves) explain_move(move, machine.get());
  print_state("after:");
  say_next(with_map_words(options, {"gcode", "check", file}));
  return kDone;
}

}  // namespace chaintrue::cli
