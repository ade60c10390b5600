// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// G0, G1 and probing: from words to moves in the machine frame.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {
namespace {

void name_axes(const Block& block, Move& move) {
  const bool changes_xy = move.to.x_mm != move.from.x_mm || move.to.y_mm != move.from.y_mm;
  move.names_xy = changes_xy || move.arc || block.has('x') || block.has('y') || block.has_polar();
  // An arc in G18 or G19 changes height even if it returns to it.
  move.names_z =
      move.to.z_mm != move.from.z_mm || block.has('z') || (move.arc && move.arc->is_upright());
}

}  // namespace

Point Interpreter::on_sheet(const Axes& machine) const {
  return {machine[0] + dialect_.home_mm[0], machine[1] + dialect_.home_mm[1], machine[2]};
}

Move Interpreter::basic_move(MoveKind kind, const Axes& to) const {
  Move move;
  move.kind = kind;
  move.line = block_.line;
  move.from = on_sheet(machine_);
  move.to = on_sheet(to);
  move.feed = {modes_.feed_mode, modes_.feed};
  for (std::size_t i = 0; i < move.turn_deg.size(); ++i)
    move.turn_deg[i] = to[i + 3] - machine_[i + 3];
  return move;
}

void Interpreter::move(int motion) {
  moves_ = true;
  check_start(motion);
  switch (motion) {
    case g::rapid:
    case g::line: {
      modes_.motion = motion;
      if (block_.is(g::machine_frame)) {
        if (block_.has_z_alone()) return machine_height(motion);
        note("home_assumed",
             "G53 with X or Y moves in machine coordinates, whose position on the sheet is "
             "unknown; write sheet coordinates without G53, and put G53 with Z on a separate line",
             unknown_home);
      }
      const auto machine = target();
      return straight(motion == g::rapid ? MoveKind::rapid : MoveKind::feed, machine);
    }
    case g::arc_clockwise:
    case g::arc_counterclockwise:
      modes_.motion = motion;
      return arc(motion == g::arc_clockwise);
    default:
      if (!is_probe(motion)) return cycle(motion);
      modes_.motion = motion;
      return probe();
  }
}

double Interpreter::axis_value(std::size_t axis) const {
  const char letter = kAxisLetters[axis];
  return axis < 3 ? length(letter) : block_.value(letter);
}

/// The target of the block's axis words, in the machine frame.
Axes Interpreter::target() const {
  const bool in_machine = block_.is(g::machine_frame);
  Axes place = in_machine ? machine_ : to_program(machine_);
  if (block_.has_polar()) {
    if (in_machine) refuse(bad_word_value, block_, "G53 does not accept polar coordinates");
    polar(place);
  }
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (!block_.has(kAxisLetters[i])) continue;
    const double value = axis_value(i);
    place[i] = modes_.incremental ? place[i] + value : value;
  }
  return in_machine ? place : to_machine(place);
}

/// Whether the program has stated the place that it steps from.
void Interpreter::check_start(int motion) {
  for (const std::size_t axis : {0U, 1U}) {
    if (!block_.has(kAxisLetters[axis]) && !block_.has_polar() && !is_arc(motion)) continue;
    if (modes_.incremental && !placed_[axis]) {
      note_once("start_relative",
                "the program is relative (G91) before its first absolute position, so where it "
                "cuts depends on where the tool happens to be; add a first line that moves to its "
                "start on the sheet, such as G90 G0 X0 Y0",
                unknown_start);
    }
    placed_[axis] = true;
  }
}

/// Passed unchanged, because only the machine knows where that is in the work's frame.
void Interpreter::pass_height(std::string text, Code code) {
  moves_ = z_unknown_ = z_is_machine_ = true;
  sink_.word({block_.line, std::move(text), code, true});
}

/// A height above the machine's switch or stop, which no work offset reaches.
void Interpreter::machine_height(int motion) {
  std::string text = with_value(motion == g::rapid ? "G53 G0 Z" : "G53 G1 Z", length('z'));
  if (motion != g::rapid) {
    if (modes_.feed_mode == FeedMode::inverse_time) {
      refuse(unsupported_code, block_,
             "a height in machine coordinates (G53) needs a feed rate in mm/min or inch/min");
    }
    text += with_value(" F", modes_.feed);
  }
  pass_height(std::move(text), g::machine_frame);
}

/// A slope begins at a height that is known.
void Interpreter::check_height(const Axes& machine) const {
  if (!block_.has('z') || !z_unknown_) return;
  if (modes_.incremental) {
    refuse(unsupported_code, block_.place('z'),
           "after probing, G53, G28 or G30 the height is known only to the machine, so Z cannot be "
           "relative (G91) here");
  }
  if (z_is_machine_ && (machine[0] != machine_[0] || machine[1] != machine_[1])) {
    refuse(unsupported_code, block_.place('z'),
           "after a height in machine coordinates (G53, G28, G30) Z must move first, without X and "
           "Y, because the height where it starts is known only to the machine");
  }
}

/// @ is the distance from the program's zero in XY, ^ the angle in degrees.
void Interpreter::polar(Axes& program) const {
  if (modes_.plane != g::plane_xy) {
    refuse(bad_word_value, block_, "polar coordinates (@, ^) are for the XY plane (G17)");
  }
  if (block_.has('x') || block_.has('y')) {
    refuse(modal_conflict, block_, "a point has either X and Y or polar coordinates (@, ^)");
  }
  double radius = std::hypot(program[0], program[1]);
  double angle_deg = std::atan2(program[1], program[0]) / kRadiansPerDegree;
  if ((modes_.incremental || !block_.has('^')) && radius == 0.0) {
    refuse(bad_word_value, block_, "a relative polar move has no direction at the program's zero");
  }
  if (block_.has('@')) radius = (modes_.incremental ? radius : 0.0) + length('@');
  if (block_.has('^')) angle_deg = (modes_.incremental ? angle_deg : 0.0) + block_.value('^');
  program[0] = radius * std::cos(angle_deg * kRadiansPerDegree);
  program[1] = radius * std::sin(angle_deg * kRadiansPerDegree);
}

void Interpreter::run(Move move, const Axes& machine) {
  check_height(machine);
  if (block_.has('z')) z_unknown_ = z_is_machine_ = false;
  name_axes(block_, move);
  sink_.move(move);
  machine_ = machine;
}

void Interpreter::straight(MoveKind kind, const Axes& machine) {
  run(basic_move(kind, machine), machine);
}

void Interpreter::probe() {
  if (!block_.has('x') && !block_.has('y') && !block_.has('z')) {
    refuse(missing_word, block_, "probing needs an axis word");
  }
  const auto machine = target();
  if (machine[0] != machine_[0] || machine[1] != machine_[1]) {
    refuse(unsupported_code, block_,
           "probing sideways (X, Y) ends at a position known only to the machine");
  }
  if (std::fabs(machine[2] - machine_[2]) < 0.254) {
    refuse(bad_word_value, block_, "the probe starts less than 0.254 mm (0.01 inch) from its end");
  }
  straight(MoveKind::probe, machine);
  z_unknown_ = true;
  z_is_machine_ = false;
  for (int i = 0; i < 3; ++i)
    parameters_.set(parameter::kProbe + i, machine_[static_cast<std::size_t>(i)]);
}

}  // namespace chaintrue::gcode
