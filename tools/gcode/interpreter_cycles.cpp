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

namespace chaintrue::gcode {
namespace {

/// How far above the last peck's bottom the rapid stops (LinuxCNC: G83_RAPID_DELTA, 0.010 inch).
constexpr double kPeckClearanceMm = 0.254;
constexpr const char* kSpindleStands = "the cycle stops the spindle, but it is not turning";

}  // namespace

/// A cycle's numbers, in the program's frame, mm, and its moves.
struct Interpreter::Cycle {
  Interpreter& interpreter;
  int motion = 0;
  PlaneAxes axes;
  Axes program{};                // where it started; the axes outside the plane stay there
  std::array<double, 2> hole{};  // along the plane's first and second axis
  double retract = 0.0;          // the R plane
  double bottom = 0.0;
  double clear = 0.0;  // height of the retract at the end

  Axes at(double height) const;
  void go(MoveKind kind, double height) const;
  void rapid(double height) const { go(MoveKind::rapid, height); }
  void feed(double height) const { go(MoveKind::feed, height); }
  void pass(Code code, std::string_view words = {}) const { interpreter.pass(code, words); }
  void dwell() const { pass(g::dwell, with_value(" P", interpreter.sticky_.p)); }

  void drill() const;
  void peck() const;
  void tap_or_bore() const;
  void back_bore() const;
};

Axes Interpreter::Cycle::at(double height) const {
  Axes place = program;
  place[axes.first] = hole[0];
  place[axes.second] = hole[1];
  place[axes.normal] = height;
  return interpreter.to_machine(place);
}

void Interpreter::Cycle::go(MoveKind kind, double height) const {
  interpreter.step(interpreter.block_);
  const Axes machine = at(height);
  Move move = interpreter.basic_move(kind, machine);
  move.names_xy = true;
  move.names_z = true;
  interpreter.sink_.move(move);
  interpreter.machine_ = machine;
  interpreter.z_unknown_ = false;
}

void Interpreter::cycle(int motion) {
  Cycle cycle{*this, motion, plane_axes(modes_.plane), to_program(machine_)};
  const char depth_letter = kAxisLetters[cycle.axes.normal];
  if (!block_.has_axes()) refuse(bad_cycle, block_, "a canned cycle needs axis words");
  if (block_.has('a') || block_.has('b') || block_.has('c') || block_.has_polar()) {
    refuse(bad_cycle, block_, "a canned cycle accepts only X, Y and Z");
  }
  if (z_unknown_) {
    refuse(unsupported_code, block_,
           "after probing, G53, G28 or G30 the start of a cycle is known only to the machine");
  }
  const bool again = modes_.motion == motion;
  const bool within = is_cycle(modes_.motion) && sticky_.plane == modes_.plane;
  // G98 returns to the height at the start of the row of cycles in this plane; with G91, R is
  // relative to it.
  if (!within) sticky_.start = cycle.program[cycle.axes.normal];
  sticky_.plane = modes_.plane;
  const auto sticky = [&](char letter, double& kept, bool is_length) -> bool {
    if (block_.has(letter)) kept = is_length ? length(letter) : block_.value(letter);
    return block_.has(letter) || again;
  };
  if (!sticky('r', sticky_.r, true)) {
    refuse(bad_cycle, block_, "the cycle's R (the height of its retract plane) is missing");
  }
  if (!sticky(depth_letter, sticky_.depth, true)) {
    refuse(bad_cycle, block_, "the cycle's depth is missing");
  }
  const bool dwells = motion == g::drill_dwell || motion == g::bore_stop ||
                      motion == g::bore_manual || motion == g::bore_dwell;
  if (!sticky('p', sticky_.p, false)) {
    if (dwells) refuse(bad_cycle, block_, "the cycle's dwell time P is missing");
    sticky_.p = 0.0;
  }
  const bool pecks = motion == g::peck_break || motion == g::peck;
  if (!sticky('q', sticky_.q, true) && pecks) {
    refuse(bad_cycle, block_, "the cycle's peck depth Q is missing");
  }
  if (pecks && !(sticky_.q > 0.0)) {
    refuse(bad_cycle, block_, "the depth Q must be positive");
  }
  if (sticky_.p < 0.0) refuse(bad_cycle, block_, "the dwell time is negative");
  const double repeats = block_.find('l').value_or(1.0);
  if (!(repeats >= 1.0) || std::round(repeats) != repeats) {
    refuse(bad_cycle, block_, "the repeat count of a cycle must be a whole number of at least 1");
  }

  double height = cycle.program[cycle.axes.normal];
  const std::size_t axes[] = {cycle.axes.first, cycle.axes.second};
  const auto word = [&](std::size_t axis, double otherwise) {
    return block_.has(kAxisLetters[axis]) ? length(kAxisLetters[axis]) : otherwise;
  };
  std::array<double, 2> place{};
  std::array<double, 2> stride{};
  for (const std::size_t i : {0U, 1U}) {
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
    refuse(bad_cycle, block_, "the retract plane R is below the cycle's bottom");
  }
  modes_.motion = motion;
  // From below the R plane first straight up to it; a row that began below it goes to it even from
  // a higher retract.
  if (sticky_.start < cycle.retract && height != cycle.retract) {
    cycle.rapid(cycle.retract);
    height = cycle.retract;
  }
  // Traverse no lower than the height at the start of the row (G98) or the R plane (G99).
  height = std::max(height, modes_.retract_to_r ? cycle.retract : sticky_.start);
  cycle.clear = modes_.retract_to_r ? cycle.retract : std::max(sticky_.start, cycle.retract);
  for (double count = repeats; count > 0.0; count -= 1.0) {
    for (const std::size_t i : {0U, 1U}) cycle.hole[i] = place[i] += stride[i];
    cycle.rapid(height);
    if (height != cycle.retract) cycle.rapid(cycle.retract);
    if (motion == g::back_bore) {
      cycle.back_bore();
    } else if (pecks) {
      cycle.peck();
    } else if (motion == g::drill || motion == g::drill_dwell) {
      cycle.drill();
    } else {
      cycle.tap_or_bore();
    }
    height = cycle.clear;
  }
}

/// G81, G82
void Interpreter::Cycle::drill() const {
  feed(bottom);
  if (motion == g::drill_dwell) dwell();
  rapid(clear);
}

/// G73, G83
void Interpreter::Cycle::peck() const {
  const double step = interpreter.sticky_.q;
  for (double depth = retract - step; depth > bottom; depth -= step) {
    feed(depth);
    if (motion == g::peck) rapid(retract);
    rapid(depth + kPeckClearanceMm);
  }
  feed(bottom);
  rapid(clear);
}

/// G84, G85, G86, G88, G89
void Interpreter::Cycle::tap_or_bore() const {
  const int spindle = interpreter.modes_.spindle;
  const bool stops_spindle = motion == g::tap || motion == g::bore_stop || motion == g::bore_manual;
  if (motion == g::tap && spindle != 3) {
    refuse(bad_cycle, interpreter.block_, "tapping (G84) needs the spindle to turn clockwise");
  }
  if (stops_spindle && spindle == 0) refuse(bad_cycle, interpreter.block_, kSpindleStands);
  feed(bottom);
  if (motion == g::tap) {
    for (const int number : {5, 4}) pass(m(number));
    dwell();
    feed(clear);
    for (const int number : {5, 3}) pass(m(number));
    return;
  }
  if (motion == g::bore) {
    feed(retract);
    return rapid(clear);
  }
  dwell();
  if (motion == g::bore_dwell) return feed(clear);
  pass(m(5));
  if (motion == g::bore_stop) {
    rapid(clear);
  } else {
    // The user retracts by hand while the program is stopped.
    pass(m(0));
    interpreter.machine_ = at(clear);
  }
  pass(m(spindle));
}

/// G87: through the hole with an oriented spindle, bored from below.
void Interpreter::Cycle::back_bore() const {
  const Code start = m(interpreter.modes_.spindle);
  if (start == m(0)) refuse(bad_cycle, interpreter.block_, kSpindleStands);
  const char words[] = {'i', 'j', 'k'};
  for (const char letter : words) {
    if (!interpreter.block_.has(letter))
      refuse(bad_cycle, interpreter.block_, "back boring (G87) needs I, J and K");
  }
  const auto length = [&](std::size_t axis) { return interpreter.length(words[axis]); };
  Cycle aside = *this;
  aside.hole[0] += length(axes.first);
  aside.hole[1] += length(axes.second);
  const double depth = length(axes.normal);
  aside.rapid(retract);
  for (const int number : {5, 19}) pass(m(number));
  aside.rapid(bottom);
  rapid(bottom);
  pass(start);
  feed(interpreter.modes_.incremental ? bottom + depth : depth);
  feed(bottom);
  for (const int number : {5, 19}) pass(m(number));
  aside.rapid(bottom);
  aside.rapid(clear);
  rapid(clear);
  pass(start);
}

}  // namespace chaintrue::gcode
