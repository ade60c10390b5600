// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/plotter/settings_to_paste.hpp"

#include <fmt/format.h>

#include <cmath>

namespace chaintrue::grid {
namespace {

using model::PlotterFirmware;

/// Rounded to 0.01 mm, without a negative zero.
std::string coordinate(double value_mm) {
  return fmt::format("{:.2f}", std::round(100.0 * value_mm) / 100.0 + 0.0);
}

/// "80.1234", or the factor where the present value is not known.
std::string steps_text(const SetPlotter& set, const PlotterMachine& found, Side side) {
  const double factor = more_steps(set, found, side);
  if (set.steps_per_mm[side] > 0.0) return fmt::format("{:.4f}", set.steps_per_mm[side] * factor);
  return fmt::format("<the present value times {:.6f}>", factor);
}

/// The position of the pen when the machine is switched on, in the controller's coordinates.
void add_home(const SetPlotter& next, std::vector<std::string>& lines) {
  if (!next.home) return;
  lines.push_back(fmt::format("G92 X{} Y{}", coordinate(next.home->x_mm + next.pins_middle.x_mm),
                              coordinate(next.home->y_mm + next.pins_middle.y_mm)));
}

std::vector<std::string> fluidnc_lines(const SetPlotter& set, const PlotterMachine& found,
                                       const SetPlotter& next) {
  const double half = 0.5 * next.machine.pin_spacing_mm, up = 0.5 * next.machine.pin_rise_mm;
  const BedPoint middle = set.pins_middle;
  return {"kinematics:",
          "  WallPlotter:",
          fmt::format("    left_anchor_x: {}", coordinate(middle.x_mm - half)),
          fmt::format("    left_anchor_y: {}", coordinate(middle.y_mm - up)),
          fmt::format("    right_anchor_x: {}", coordinate(middle.x_mm + half)),
          fmt::format("    right_anchor_y: {}", coordinate(middle.y_mm + up)),
          "axes:",
          "  x:",
          "    steps_per_mm: " + steps_text(set, found, Side::left),
          "  y:",
          "    steps_per_mm: " + steps_text(set, found, Side::right)};
}

std::vector<std::string> marlin_lines(const SetPlotter& set, const PlotterMachine& found,
                                      const SetPlotter& next) {
  const BedPoint middle = set.pins_middle;
  return {fmt::format("M92 X{} Y{}", steps_text(set, found, Side::left),
                      steps_text(set, found, Side::right)),
          fmt::format(
              "M665 L{} R{} T{}", coordinate(middle.x_mm - 0.5 * next.machine.pin_spacing_mm),
              coordinate(middle.x_mm + 0.5 * next.machine.pin_spacing_mm), coordinate(middle.y_mm)),
          "M500"};
}

std::vector<std::string> polargraph_lines(const SetPlotter& set, const PlotterMachine& found,
                                          const SetPlotter& next) {
  // The steps of a turn are fixed, so the turn's length changes instead.
  return {fmt::format("machine.width={:.1f}", next.machine.pin_spacing_mm),
          fmt::format("machine.motors.mmPerRev=<the present value times {:.6f}>",
                      1.0 / more_steps(set, found, Side::left))};
}

std::vector<std::string> mural_lines(const SetPlotter& next) {
  return {fmt::format("top distance: {:.0f} mm", next.machine.pin_spacing_mm),
          fmt::format("effective pulley diameter: {:.4f} mm", 2.0 * next.machine.pulley_radius_mm),
          fmt::format("homed step offset: {:.2f} mm", next.homed_offset_mm)};
}

}  // namespace

std::vector<std::string> settings_to_paste(const SetPlotter& set, const PlotterMachine& found) {
  const SetPlotter next = once_typed_in(set, found);
  std::vector<std::string> lines;
  switch (set.firmware) {
    case PlotterFirmware::fluidnc:
      lines = fluidnc_lines(set, found, next);
      break;
    case PlotterFirmware::marlin:
      lines = marlin_lines(set, found, next);
      break;
    case PlotterFirmware::polargraph:
      lines = polargraph_lines(set, found, next);
      break;
    case PlotterFirmware::mural:
      return mural_lines(next);
  }
  add_home(next, lines);
  return lines;
}

}  // namespace chaintrue::grid
