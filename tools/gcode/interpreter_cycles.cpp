// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Canned cycles G73 and G81 to G89, expanded into moves as in LinuxCNC.
///
/// A cycle works in the active plane; "depth" is along the plane's normal. Words that a following
/// block of the same cycle omits keep their values.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {
namespace {

/// How far above the last peck's bottom the rapid stops (LinuxCNC: G83_RAPID_DELTA, 0.010 inch).
constexpr double kPeckClearanceMm = 0.254;

}  // namespace

/// A cycle's numbers, in the program's frame, mm.
struct Interpreter::Cycle {
  int motion = 0;
  PlaneAxes axes;
  std::array<double, 2> hole{};  // along the plane's first and second axis
  double retract = 0.0;          // the R plane
  double bottom = 0.0;
  double clear = 0.0;  // height of the retract at the end
  double dwell_s = 0.0;
  double peck = 0.0;
  Axes program{};  // the other axes

  [[nodiscard]] Axes at(double height) const {
    Axes place = program;
    place[axes.first] = hole[0];
    place[axes.second] = hole[1];
    place[axes.normal] = height;
    return place;
  }
};

void Interpreter::cycle_move(const Block& block, const Cycle& cycle, MoveKind kind, double height) {
  step(block.start());
  const Axes machine = to_machine(cycle.at(height));
  Move move = basic_move(block.line, kind, machine);
  move.names_xy = true;
  move.names_z = true;
  sink_.move(move);
  machine_ = machine;
  z_unknown_ = false;
}

void Interpreter::cycle(const Block& block, int motion) {
  Cycle cycle;
  cycle.motion = motion;
  cycle.axes = plane_axes(modes_.plane);
  cycle.program = to_program(machine_);
  const char depth_letter = kAxisLetters[cycle.axes.normal];
  if (!block.has_axes()) refuse(ProblemName::bad_cycle, block, "a canned cycle needs axis words");
  if (block.has('a') || block.has('b') || block.has('c') || block.has('@') || block.has('^')) {
    refuse(ProblemName::bad_cycle, block, "a canned cycle takes X, Y and Z only");
  }
  if (z_unknown_) {
    refuse(ProblemName::unsupported_code,
           block,
           "after probing, G53, G28 or G30 only the machine knows where a cycle starts");
  }
  const bool again = modes_.motion == motion;
  const bool within = is_cycle(modes_.motion) && sticky_.plane == modes_.plane;
  // G98 returns to the height at the start of the row of cycles in this plane; with G91, R is
  // relative to it.
  if (!within) sticky_.start = cycle.program[cycle.axes.normal];
  sticky_.plane = modes_.plane;
  const auto sticky = [&](char letter, double& kept, bool is_length) -> bool {
    if (block.has(letter)) kept = is_length ? length(block, letter) : block.value(letter);
    return block.has(letter) || again;
  };
  if (!sticky('r', sticky_.r, true)) {
    refuse(ProblemName::bad_cycle,
           block,
           "the cycle's R (the height of its retract plane) is missing");
  }
  if (!sticky(depth_letter, sticky_.depth, true)) {
    refuse(ProblemName::bad_cycle, block, "the cycle's depth is missing");
  }
  const bool dwells = motion == g::drill_dwell || motion == g::bore_stop ||
                      motion == g::bore_manual || motion == g::bore_dwell;
  if (!sticky('p', sticky_.p, false)) {
    if (dwells) refuse(ProblemName::bad_cycle, block, "the cycle's dwell time P is missing");
    sticky_.p = 0.0;
  }
  const bool pecks = motion == g::peck_break || motion == g::peck;
  if (!sticky('q', sticky_.q, true) && pecks) {
    refuse(ProblemName::bad_cycle, block, "the cycle's depth of a peck, Q, is missing");
  }
  if (pecks && !(sticky_.q > 0.0)) {
    refuse(ProblemName::bad_cycle, block, "the depth Q must be above zero");
  }
  if (sticky_.p < 0.0) refuse(ProblemName::bad_cycle, block, "the dwell time is below zero");
  const double repeats = block.find('l').value_or(1.0);
  if (!(repeats >= 1.0) || std::round(repeats) != repeats) {
    refuse(ProblemName::bad_cycle,
           block,
           "a cycle is repeated a whole number of times, at least once");
  }

  double height = cycle.program[cycle.axes.normal];
  const std::size_t axes[] = {cycle.axes.first, cycle.axes.second};
  const auto word = [&](std::size_t axis, double otherwise) {
    return block.has(kAxisLetters[axis]) ? length(block, kAxisLetters[axis]) : otherwise;
  };
  std::array<double, 2> place{};
  std::array<double, 2> stride{};
  for (const std::size_t i : {0, 1}) {
    cycle.hole[i] = place[i] = cycle.program[axes[i]];
    if (modes_.incremental) {
      stride[i] = word(axes[i], 0.0);
    } else {
      place[i] = word(axes[i], place[i]);
    }
  }
  cycle.retract = sticky_.r + (modes_.incremental ? sticky_.start : 0.0);
  cycle.bottom = sticky_.depth + (modes_.incremental ? cycle.retract : 0.0);
  if (cycle.retract < cycle.bottom) {
    refuse(ProblemName::bad_cycle, block, "the retract plane R lies below the cycle's bottom");
  }
  cycle.dwell_s = sticky_.p;
  cycle.peck = sticky_.q;
  modes_.motion = motion;
  // From below the R plane first straight up to it; a row that began below it goes to it even from
  // a higher retract.
  if (sticky_.start < cycle.retract && height != cycle.retract) {
    cycle_move(block, cycle, MoveKind::rapid, cycle.retract);
    height = cycle.retract;
  }
  // G98 does not traverse below the height at the start of the row.
  if (!modes_.retract_to_r) height = std::max(height, sticky_.start);
  cycle.clear = modes_.retract_to_r ? cycle.retract : std::max(sticky_.start, cycle.retract);
  for (double count = repeats; count > 0.0; count -= 1.0) {
    for (const std::size_t i : {0, 1}) cycle.hole[i] = place[i] += stride[i];
    cycle_move(block, cycle, MoveKind::rapid, height);
    if (height != cycle.retract) {
      cycle_move(block, cycle, MoveKind::rapid, cycle.retract);
    }
    motion == g::back_bore                           ? back_bore(block, cycle)
    : pecks                                          ? peck(block, cycle)
    : motion == g::drill || motion == g::drill_dwell ? drill(block, cycle)
                                                     : tap_or_bore(block, cycle);
    height = cycle.clear;
  }
}

/// G81, G82
void Interpreter::drill(const Block& block, const Cycle& cycle) {
  cycle_move(block, cycle, MoveKind::feed, cycle.bottom);
  if (cycle.motion == g::drill_dwell) pass(block, g::dwell, with_value(" P", cycle.dwell_s));
  cycle_move(block, cycle, MoveKind::rapid, cycle.clear);
}

/// G73, G83
void Interpreter::peck(const Block& block, const Cycle& cycle) {
  for (double depth = cycle.retract - cycle.peck; depth > cycle.bottom; depth -= cycle.peck) {
    cycle_move(block, cycle, MoveKind::feed, depth);
    if (cycle.motion == g::peck) {
      cycle_move(block, cycle, MoveKind::rapid, cycle.retract);
    }
    cycle_move(block, cycle, MoveKind::rapid, depth + kPeckClearanceMm);
  }
  cycle_move(block, cycle, MoveKind::feed, cycle.bottom);
  cycle_move(block, cycle, MoveKind::rapid, cycle.clear);
}

/// G84, G85, G86, G88, G89
void Interpreter::tap_or_bore(const Block& block, const Cycle& cycle) {
  const int motion = cycle.motion;
  const bool stops_spindle = motion == g::tap || motion == g::bore_stop || motion == g::bore_manual;
  if (motion == g::tap && modes_.spindle != 3) {
    refuse(ProblemName::bad_cycle, block, "tapping (G84) needs the spindle turning clockwise");
  }
  if (stops_spindle && modes_.spindle == 0) {
    refuse(ProblemName::bad_cycle, block, "the cycle stops the spindle, but it is not turning");
  }
  const Code start = m(modes_.spindle);
  const std::string dwell = with_value(" P", cycle.dwell_s);
  cycle_move(block, cycle, MoveKind::feed, cycle.bottom);
  if (motion == g::tap) {
    for (const int number : {5, 4}) pass(block, m(number));
    pass(block, g::dwell, dwell);
    cycle_move(block, cycle, MoveKind::feed, cycle.clear);
    for (const int number : {5, 3}) pass(block, m(number));
    return;
  }
  if (motion == g::bore) {
    cycle_move(block, cycle, MoveKind::feed, cycle.retract);
    return cycle_move(block, cycle, MoveKind::rapid, cycle.clear);
  }
  pass(block, g::dwell, dwell);
  if (motion == g::bore_dwell) return cycle_move(block, cycle, MoveKind::feed, cycle.clear);
  pass(block, m(5));
  if (motion == g::bore_stop) {
    cycle_move(block, cycle, MoveKind::rapid, cycle.clear);
  } else {
    // The user retracts by hand while the program is stopped.
    pass(block, m(0));
    machine_ = to_machine(cycle.at(cycle.clear));
  }
  pass(block, start);
}

/// G87: through the hole with an oriented spindle, bored from below.
void Interpreter::back_bore(const Block& block, const Cycle& cycle) {
  if (modes_.spindle == 0) {
    refuse(ProblemName::bad_cycle, block, "the cycle stops the spindle, but it is not turning");
  }
  const char words[] = {'i', 'j', 'k'};
  for (const char letter : words) {
    if (!block.has(letter)) {
      refuse(ProblemName::bad_cycle, block, "back boring (G87) needs I, J and K");
    }
  }
  Cycle aside = cycle;
  aside.hole[0] += length(block, words[cycle.axes.first]);
  aside.hole[1] += length(block, words[cycle.axes.second]);
  const double middle = modes_.incremental ? cycle.bottom + length(block, words[cycle.axes.normal])
                                           : length(block, words[cycle.axes.normal]);
  const Code start = m(modes_.spindle);
  cycle_move(block, aside, MoveKind::rapid, cycle.retract);
  for (const int number : {5, 19}) pass(block, m(number));
  cycle_move(block, aside, MoveKind::rapid, cycle.bottom);
  cycle_move(block, cycle, MoveKind::rapid, cycle.bottom);
  pass(block, start);
  cycle_move(block, cycle, MoveKind::feed, middle);
  cycle_move(block, cycle, MoveKind::feed, cycle.bottom);
  for (const int number : {5, 19}) pass(block, m(number));
  cycle_move(block, aside, MoveKind::rapid, cycle.bottom);
  cycle_move(block, aside, MoveKind::rapid, cycle.clear);
  cycle_move(block, cycle, MoveKind::rapid, cycle.clear);
  pass(block, start);
}

}  // namespace chaintrue::gcode
