// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Canned cycles G73 and G81 to G89, expanded into moves as in LinuxCNC.
///
/// A cycle works in the active plane; "depth" is along the plane's normal. Words that a following
/// block of the same cycle omits keep their values.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/word_text.hpp"

namespace chaintrue::gcode {
namespace {

/// How far above the last peck's bottom the rapid stops (LinuxCNC: G83_RAPID_DELTA, 0.010 inch).
constexpr double kPeckClearanceMm = 0.254;

}  // namespace

/// A cycle's numbers, in the program's frame, mm.
struct Interpreter::Cycle {
  int motion = 0;
  std::size_t first = 0;  // index of the plane's first axis
  std::size_t second = 1;
  std::size_t normal = 2;
  double retract = 0.0;  // the R plane
  double bottom = 0.0;
  double clear = 0.0;  // height of the retract at the end
  double dwell_s = 0.0;
  double peck = 0.0;
  Axes program{};  // the other axes
};

Result<void> Interpreter::cycle_move(const Block& block,
                                     const Cycle& cycle,
                                     MoveKind kind,
                                     const std::array<double, 3>& to) {
  CHAINTRUE_GCODE_TRY(step(block.start()));
  Axes program = cycle.program;
  program[cycle.first] = to[0];
  program[cycle.second] = to[1];
  program[cycle.normal] = to[2];
  const Axes machine = to_machine(program);
  Move move = basic_move(block.line, kind, machine);
  move.names_xy = true;
  move.names_z = true;
  CHAINTRUE_GCODE_TRY(sink_.move(move));
  machine_ = machine;
  z_unknown_ = false;
  return {};
}

Result<void> Interpreter::cycle(const Block& block, int motion) {
  Cycle cycle;
  cycle.motion = motion;
  if (modes_.plane == 180) cycle = Cycle{motion, 2, 0, 1};
  if (modes_.plane == 190) cycle = Cycle{motion, 1, 2, 0};
  cycle.program = to_program(machine_);
  const char depth_letter = kAxisLetters[cycle.normal];
  if (!block.has_axes())
    return refuse(ProblemName::bad_cycle, block.start(), "a canned cycle needs axis words");
  if (block.has('a') || block.has('b') || block.has('c') || block.has('@') || block.has('^')) {
    return refuse(ProblemName::bad_cycle, block.start(), "a canned cycle takes X, Y and Z only");
  }
  if (z_unknown_) {
    return refuse(ProblemName::unsupported_code,
                  block.start(),
                  "after probing, G53, G28 or G30 only the machine knows where a cycle starts");
  }
  const bool again = modes_.motion == motion;
  const bool within = is_cycle(modes_.motion) && sticky_.plane == modes_.plane;
  // G98 returns to the height at the start of the row of cycles in this plane; with G91, R is
  // relative to it.
  if (!within) sticky_.start = cycle.program[cycle.normal];
  sticky_.plane = modes_.plane;
  const auto sticky = [&](char letter, double& kept, bool is_length) -> bool {
    if (block.has(letter)) kept = is_length ? length(block, letter) : block.value(letter);
    return block.has(letter) || again;
  };
  if (!sticky('r', sticky_.r, true)) {
    return refuse(ProblemName::bad_cycle,
                  block.start(),
                  "the cycle's R (the height of its retract plane) is missing");
  }
  if (!sticky(depth_letter, sticky_.depth, true)) {
    return refuse(ProblemName::bad_cycle, block.start(), "the cycle's depth is missing");
  }
  const bool dwells = motion == 820 || motion == 860 || motion == 880 || motion == 890;
  if (!sticky('p', sticky_.p, false)) {
    if (dwells)
      return refuse(ProblemName::bad_cycle, block.start(), "the cycle's dwell time P is missing");
    sticky_.p = 0.0;
  }
  const bool pecks = motion == 730 || motion == 830;
  if (!sticky('q', sticky_.q, true) && pecks) {
    return refuse(
        ProblemName::bad_cycle, block.start(), "the cycle's depth of a peck, Q, is missing");
  }
  if (pecks && !(sticky_.q > 0.0)) {
    return refuse(ProblemName::bad_cycle, block.start(), "the depth Q must be above zero");
  }
  if (sticky_.p < 0.0)
    return refuse(ProblemName::bad_cycle, block.start(), "the dwell time is below zero");
  const double repeats = block.find('l').value_or(1.0);
  if (!(repeats >= 1.0) || std::round(repeats) != repeats) {
    return refuse(ProblemName::bad_cycle,
                  block.start(),
                  "a cycle is repeated a whole number of times, at least once");
  }

  double height = cycle.program[cycle.normal];
  double first = cycle.program[cycle.first];
  double second = cycle.program[cycle.second];
  const double here_first = first;
  const double here_second = second;
  const auto word = [&](std::size_t axis, double otherwise) {
    return block.has(kAxisLetters[axis]) ? length(block, kAxisLetters[axis]) : otherwise;
  };
  double step_first = 0.0;
  double step_second = 0.0;
  if (modes_.incremental) {
    step_first = word(cycle.first, 0.0);
    step_second = word(cycle.second, 0.0);
    cycle.retract = sticky_.r + sticky_.start;
    cycle.bottom = sticky_.depth + cycle.retract;
  } else {
    first = word(cycle.first, first);
    second = word(cycle.second, second);
    cycle.retract = sticky_.r;
    cycle.bottom = sticky_.depth;
  }
  if (cycle.retract < cycle.bottom) {
    return refuse(
        ProblemName::bad_cycle, block.start(), "the retract plane R lies below the cycle's bottom");
  }
  cycle.dwell_s = sticky_.p;
  cycle.peck = sticky_.q;
  modes_.motion = motion;
  // From below the R plane first straight up to it; a row that began below it goes to it even from
  // a higher retract.
  if (sticky_.start < cycle.retract && height != cycle.retract) {
    CHAINTRUE_GCODE_TRY(
        cycle_move(block, cycle, MoveKind::rapid, {here_first, here_second, cycle.retract}));
    height = cycle.retract;
  }
  // G98 does not traverse below the height at the start of the row.
  if (!modes_.retract_to_r) height = std::max(height, sticky_.start);
  cycle.clear = modes_.retract_to_r ? cycle.retract : std::max(sticky_.start, cycle.retract);
  for (double count = repeats; count > 0.0; count -= 1.0) {
    first += step_first;
    second += step_second;
    CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::rapid, {first, second, height}));
    if (height != cycle.retract) {
      CHAINTRUE_GCODE_TRY(
          cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.retract}));
    }
    CHAINTRUE_GCODE_TRY(motion == 870 ? back_bore(block, cycle, first, second)
                        : pecks       ? peck(block, cycle, first, second)
                        : motion == 810 || motion == 820
                            ? drill(block, cycle, first, second)
                            : tap_or_bore(block, cycle, first, second));
    height = cycle.clear;
  }
  return {};
}

/// G81, G82
Result<void> Interpreter::drill(const Block& block,
                                const Cycle& cycle,
                                double first,
                                double second) {
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.bottom}));
  if (cycle.motion == 820) CHAINTRUE_GCODE_TRY(pass(block, with_value("G4 P", cycle.dwell_s)));
  return cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.clear});
}

/// G73, G83
Result<void> Interpreter::peck(const Block& block,
                               const Cycle& cycle,
                               double first,
                               double second) {
  for (double depth = cycle.retract - cycle.peck; depth > cycle.bottom; depth -= cycle.peck) {
    CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, depth}));
    if (cycle.motion == 830) {
      CHAINTRUE_GCODE_TRY(
          cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.retract}));
    }
    CHAINTRUE_GCODE_TRY(
        cycle_move(block, cycle, MoveKind::rapid, {first, second, depth + kPeckClearanceMm}));
  }
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.bottom}));
  return cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.clear});
}

/// G84, G85, G86, G88, G89
Result<void> Interpreter::tap_or_bore(const Block& block,
                                      const Cycle& cycle,
                                      double first,
                                      double second) {
  const int motion = cycle.motion;
  const bool stops_spindle = motion == 840 || motion == 860 || motion == 880;
  if (motion == 840 && modes_.spindle != 3) {
    return refuse(
        ProblemName::bad_cycle, block.start(), "tapping (G84) needs the spindle turning clockwise");
  }
  if (stops_spindle && modes_.spindle == 0) {
    return refuse(ProblemName::bad_cycle,
                  block.start(),
                  "the cycle stops the spindle, but it is not turning");
  }
  const std::string start = fmt::format("M{}", modes_.spindle);
  const std::string dwell = with_value("G4 P", cycle.dwell_s);
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.bottom}));
  if (motion == 840) {
    for (const char* word : {"M5", "M4"}) CHAINTRUE_GCODE_TRY(pass(block, word));
    CHAINTRUE_GCODE_TRY(pass(block, dwell));
    CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.clear}));
    for (const char* word : {"M5", "M3"}) CHAINTRUE_GCODE_TRY(pass(block, word));
    return {};
  }
  if (motion == 850) {
    CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.retract}));
    return cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.clear});
  }
  CHAINTRUE_GCODE_TRY(pass(block, dwell));
  if (motion == 890) return cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.clear});
  CHAINTRUE_GCODE_TRY(pass(block, "M5"));
  if (motion == 860) {
    CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.clear}));
  } else {
    // The user retracts by hand while the program is stopped.
    CHAINTRUE_GCODE_TRY(pass(block, "M0"));
    Axes program = cycle.program;
    program[cycle.first] = first;
    program[cycle.second] = second;
    program[cycle.normal] = cycle.clear;
    machine_ = to_machine(program);
  }
  return pass(block, start);
}

/// G87: through the hole with an oriented spindle, bored from below.
Result<void> Interpreter::back_bore(const Block& block,
                                    const Cycle& cycle,
                                    double first,
                                    double second) {
  if (modes_.spindle == 0) {
    return refuse(ProblemName::bad_cycle,
                  block.start(),
                  "the cycle stops the spindle, but it is not turning");
  }
  const char words[] = {'i', 'j', 'k'};
  for (const char letter : words) {
    if (!block.has(letter)) {
      return refuse(ProblemName::bad_cycle, block.start(), "back boring (G87) needs I, J and K");
    }
  }
  const double aside_first = first + length(block, words[cycle.first]);
  const double aside_second = second + length(block, words[cycle.second]);
  const double middle = modes_.incremental ? cycle.bottom + length(block, words[cycle.normal])
                                           : length(block, words[cycle.normal]);
  const std::string start = fmt::format("M{}", modes_.spindle);
  CHAINTRUE_GCODE_TRY(
      cycle_move(block, cycle, MoveKind::rapid, {aside_first, aside_second, cycle.retract}));
  for (const char* word : {"M5", "M19"}) CHAINTRUE_GCODE_TRY(pass(block, word));
  CHAINTRUE_GCODE_TRY(
      cycle_move(block, cycle, MoveKind::rapid, {aside_first, aside_second, cycle.bottom}));
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.bottom}));
  CHAINTRUE_GCODE_TRY(pass(block, start));
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, middle}));
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::feed, {first, second, cycle.bottom}));
  for (const char* word : {"M5", "M19"}) CHAINTRUE_GCODE_TRY(pass(block, word));
  CHAINTRUE_GCODE_TRY(
      cycle_move(block, cycle, MoveKind::rapid, {aside_first, aside_second, cycle.bottom}));
  CHAINTRUE_GCODE_TRY(
      cycle_move(block, cycle, MoveKind::rapid, {aside_first, aside_second, cycle.clear}));
  CHAINTRUE_GCODE_TRY(cycle_move(block, cycle, MoveKind::rapid, {first, second, cycle.clear}));
  return pass(block, start);
}

}  // namespace chaintrue::gcode
