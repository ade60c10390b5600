// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue gcode explain.
#include <fmt/format.h>

#include <charconv>
#include <string>
#include <vector>

#include "tools/cli/gcode_job.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {
namespace {

/// Stores the actions of one line.
struct LineEvents final : gcode::Sink {
  void move(const gcode::Move& move) override {
    if (listening) moves.push_back(move);
  }
  void word(const gcode::PassedWord& word) override {
    if (listening) words += fmt::format(" {}", word.text);
  }
  bool listening = false;
  std::vector<gcode::Move> moves;
  std::string words;
};

void explain_move(const gcode::Move& move, const GcodeMachine* machine) {
  const BedPoint target{move.to.x_mm, move.to.y_mm};
  fmt::print("  {} to X{:.4f} Y{:.4f} Z{:.4f} mm on the sheet, {:.4f} mm long\n",
             gcode::name(move.kind), target.x_mm, target.y_mm, move.to.z_mm,
             gcode::length_mm(move));
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

/// `machine` is null without a map.
int explain_line(const GcodeMachine* machine, const GcodeOptions& options) {
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
  for (const gcode::Move& move : events.moves) explain_move(move, machine);
  print_state("after:");
  say_next(with_map_words(options, {"gcode", "check", file}));
  return kDone;
}

}  // namespace

int run_gcode_explain(const GcodeOptions& options) {
  if (options.map.empty()) return explain_line(nullptr, options);
  const GcodeMachine machine(options);
  return explain_line(&machine, options);
}

}  // namespace chaintrue::cli
