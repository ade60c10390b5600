// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The position of the program's zero: work coordinate systems, G10, G52, G92, and the homes of G28
/// and G30.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string_view>

#include "tools/gcode/interpreter.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {
namespace {

/// The parameters of coordinate system 1 .. 9.
int first_parameter(int system) { return parameter::kFirstSystem + 20 * (system - 1); }
int rotation_parameter(int system) { return first_parameter(system) + 9; }

Turn turn(double degrees) { return std::polar(1.0, degrees * std::numbers::pi / 180.0); }

Axes rotated(Axes axes, Turn by) {
  const Turn place = by * Turn(axes[0], axes[1]);
  axes[0] = place.real();
  axes[1] = place.imag();
  return axes;
}

Axes operator+(Axes a, const Axes& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::plus<>());
  return a;
}

Axes operator-(Axes a, const Axes& b) {
  std::transform(a.begin(), a.end(), b.begin(), a.begin(), std::minus<>());
  return a;
}

}  // namespace

Axes Interpreter::to_machine(const Axes& program) const {
  return rotated(program + frame_.offset, frame_.turn) + frame_.origin;
}

Axes Interpreter::to_program(const Axes& machine) const {
  return rotated(machine - frame_.origin, std::conj(frame_.turn)) - frame_.offset;
}

Axes Interpreter::stored(int first) const {
  Axes axes;
  for (std::size_t i = 0; i < axes.size(); ++i)
    axes[i] = parameters_.stored(first + static_cast<int>(i));
  return axes;
}

void Interpreter::store(int first, const Axes& axes) {
  for (std::size_t i = 0; i < axes.size(); ++i)
    parameters_.set(first + static_cast<int>(i), axes[i]);
}

void Interpreter::refresh_frame() {
  frame_.origin = stored(first_parameter(modes_.system));
  frame_.rotation_deg = parameters_.stored(rotation_parameter(modes_.system));
  frame_.turn = turn(frame_.rotation_deg);
}

void Interpreter::select_system(int system) {
  modes_.system = system;
  parameters_.set(parameter::kSystem, system);
  refresh_frame();
}

/// Codes that act once: offsets and homes. G4 and G53 are handled elsewhere.
void Interpreter::once() {
  const KnownCode* code = block_.code(Group::once);
  if (code == nullptr) return;
  switch (code->tenths) {
    case g::set_data:
      return set_system();
    case g::home:
      return go_home(parameter::kHome);
    case g::set_home:
      return store_home(parameter::kHome);
    case g::second_home:
      return go_home(parameter::kSecondHome);
    case g::set_second_home:
      return store_home(parameter::kSecondHome);
    case g::local_offset:
    case g::offset_here:
      return set_offset();
    case g::offset_off_forget:
      return cancel_offset(true);
    case g::offset_off:
      return cancel_offset(false);
    case g::offset_restore:
      parameters_.set(parameter::kOffsetOn, 1.0);
      frame_.offset = stored(parameter::kOffset);
      return;
    default:
      return;
  }
}

void Interpreter::needs_known_z() const {
  if (!z_unknown_ || !block_.has('z')) return;
  refuse(unsupported_code, block_.place('z'),
         "after probing, G53, G28 or G30 the height is known only to the machine, so Z cannot be "
         "set from it here");
}

void Interpreter::set_system() {
  const double mode = block_.find('l').value_or(-1.0);
  if (mode != 2.0 && mode != 20.0) {
    refuse(unsupported_code, block_,
           "only G10 L2 and L20 (work offsets) are supported, not tool tables");
  }
  const double number = block_.find('p').value_or(-1.0);
  if (number < 0.0 || number > 9.0 || std::round(number) != number) {
    refuse(bad_word_value, block_, "G10 needs P0 (the system in force) to P9");
  }
  const int system = number == 0.0 ? modes_.system : static_cast<int>(number);
  const bool from_here = mode == 20.0;
  if (from_here) {
    needs_known_z();
    if (block_.has('r')) {
      refuse(bad_word_value, block_.place('r'), "R (a rotation) belongs to G10 L2, not to L20");
    }
  }
  if (block_.has_polar()) {
    refuse(bad_word_value, block_, "G10 does not accept polar coordinates");
  }
  if (block_.has('r')) parameters_.set(rotation_parameter(system), block_.value('r'));

  Axes origin = stored(first_parameter(system));
  const Turn by = turn(parameters_.stored(rotation_parameter(system)));
  // The machine's position in that system.
  const Axes here = rotated(machine_ - origin, std::conj(by));
  // The change of the origin, in the system's directions, with which the machine's position has the
  // given coordinates.
  Axes shift{};
  const bool offset_on = parameters_.stored(parameter::kOffsetOn) != 0.0;
  for (std::size_t i = 0; i < origin.size(); ++i) {
    if (!block_.has(kAxisLetters[i])) continue;
    const double value = axis_value(i);
    if (from_here) {
      shift[i] = here[i] - (offset_on ? frame_.offset[i] : 0.0) - value;
    } else {
      origin[i] = value;
    }
  }
  store(first_parameter(system), origin + rotated(shift, by));
  if (system == modes_.system) refresh_frame();
}

/// G92 gives the machine's position the stated coordinates; G52 states the offset itself. They
/// share it.
void Interpreter::set_offset() {
  if (!block_.has_axes()) {
    refuse(missing_word, block_, "G52 and G92 need an axis word");
  }
  if (block_.has_polar()) {
    refuse(bad_word_value, block_, "G52 and G92 do not accept polar coordinates");
  }
  const bool from_here = block_.is(g::offset_here);
  if (from_here) needs_known_z();
  const Axes program = to_program(machine_);
  for (std::size_t i = 0; i < frame_.offset.size(); ++i) {
    if (!block_.has(kAxisLetters[i])) continue;
    const double value = axis_value(i);
    frame_.offset[i] = from_here ? program[i] + frame_.offset[i] - value : value;
    if (from_here && i < 2) placed_[i] = true;
  }
  parameters_.set(parameter::kOffsetOn, 1.0);
  store(parameter::kOffset, frame_.offset);
}

void Interpreter::cancel_offset(bool forget) {
  frame_.offset = {};
  parameters_.set(parameter::kOffsetOn, 0.0);
  if (!forget) return;
  for (int i = 0; i < 9; ++i) parameters_.set(parameter::kOffset + i, 0.0);
}

void Interpreter::store_home(int first) {
  store(first, machine_);
  known_homes_.insert(first);
}

/// Through the point of the axis words, then home with those axes; with all if none is given.
void Interpreter::go_home(int first) {
  const auto through = target();
  moves_ = true;
  if (!dialect_.home_is_zero && !known_homes_.contains(first)) {
    const Code code = first == parameter::kHome ? g::home : g::second_home;
    if (block_.has_z_alone()) {
      // In whole nanometres, which the rounding of offsets and inches leaves alone.
      const double z_mm = std::round(1e6 * (modes_.incremental ? length('z') : through[2])) / 1e6;
      const std::string word = (modes_.incremental ? "G91 " : "") + name(code) + " Z";
      return pass_height(with_value(word, z_mm), code);
    }
    note("home_assumed",
         "the position of G28 and G30 is stored in the machine, so where it is on the sheet is "
         "unknown; write sheet coordinates, and leave X and Y out of the retract (G28 G91 Z0)",
         unknown_home);
  }
  placed_[0] = placed_[1] = true;
  straight(MoveKind::rapid, through);
  const Axes home = stored(first);
  if (!block_.has_axes()) return straight(MoveKind::rapid, home);
  // The words refer to axes of the program, which differ from the machine's in a rotated frame.
  const Axes home_program = to_program(home);
  Axes program = to_program(machine_);
  for (std::size_t i = 0; i < program.size(); ++i) {
    if (block_.has(kAxisLetters[i])) program[i] = home_program[i];
  }
  return straight(MoveKind::rapid, to_machine(program));
}

}  // namespace chaintrue::gcode
