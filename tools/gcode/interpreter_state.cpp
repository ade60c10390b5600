// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The interpreter's state as parameters (#5400 .., #<_x> ..) and in words.
#include <fmt/format.h>

#include <cmath>

#include "tools/gcode/interpreter.hpp"

namespace chaintrue::gcode {

std::optional<double> Interpreter::state_by_number(int index) const {
  if (index == 5400) return static_cast<double>(modes_.tool);
  if (index < parameter::kPosition || index >= parameter::kPosition + 6) return std::nullopt;
  const auto axis = static_cast<std::size_t>(index - parameter::kPosition);
  return to_program(machine_)[axis] / (axis < 3 ? mm_per_unit() : 1.0);
}

std::optional<double> Interpreter::state_by_name(std::string_view name) const {
  if (!name.starts_with('_')) return std::nullopt;
  struct Named {
    std::string_view name;
    double (*value)(const Interpreter&);
  };
  using I = const Interpreter&;
  static constexpr auto position = [](I i, std::size_t axis) {
    return i.to_program(i.machine_)[axis] / (axis < 3 ? i.mm_per_unit() : 1.0);
  };
  static constexpr Named kNamed[] = {
      {"_x", [](I i) { return position(i, 0); }},
      {"_y", [](I i) { return position(i, 1); }},
      {"_z", [](I i) { return position(i, 2); }},
      {"_a", [](I i) { return position(i, 3); }},
      {"_b", [](I i) { return position(i, 4); }},
      {"_c", [](I i) { return position(i, 5); }},
      {"_metric", [](I i) { return i.modes_.inches ? 0.0 : 1.0; }},
      {"_imperial", [](I i) { return i.modes_.inches ? 1.0 : 0.0; }},
      {"_absolute", [](I i) { return i.modes_.incremental ? 0.0 : 1.0; }},
      {"_incremental", [](I i) { return i.modes_.incremental ? 1.0 : 0.0; }},
      {"_ijk_absolute_mode", [](I i) { return i.modes_.absolute_centres ? 1.0 : 0.0; }},
      {"_inverse_time",
       [](I i) { return i.modes_.feed_mode == FeedMode::inverse_time ? 1.0 : 0.0; }},
      {"_units_per_minute",
       [](I i) { return i.modes_.feed_mode == FeedMode::per_minute ? 1.0 : 0.0; }},
      {"_units_per_rev", [](I) { return 0.0; }},
      {"_motion_mode", [](I i) { return static_cast<double>(i.modes_.motion); }},
      {"_plane", [](I i) { return static_cast<double>(i.modes_.plane); }},
      {"_coord_system", [](I i) { return static_cast<double>(system_code(i.modes_.system)); }},
      {"_retract_r_plane", [](I i) { return i.modes_.retract_to_r ? 1.0 : 0.0; }},
      {"_retract_old_z", [](I i) { return i.modes_.retract_to_r ? 0.0 : 1.0; }},
      {"_spindle_on", [](I i) { return i.modes_.spindle != 0 ? 1.0 : 0.0; }},
      {"_spindle_cw", [](I i) { return i.modes_.spindle == 3 ? 1.0 : 0.0; }},
      {"_feed",
       [](I i) {
         return i.modes_.feed_mode == FeedMode::per_minute ? i.modes_.feed / i.mm_per_unit()
                                                           : i.modes_.feed;
       }},
      {"_rpm", [](I i) { return i.modes_.spindle_rpm; }},
      {"_current_tool", [](I i) { return static_cast<double>(i.modes_.tool); }},
      {"_selected_tool", [](I i) { return static_cast<double>(i.modes_.selected_tool); }},
      {"_call_level", [](I i) { return static_cast<double>(i.call_level_); }},
  };
  for (const Named& named : kNamed) {
    if (named.name == name) return named.value(*this);
  }
  return std::nullopt;
}

std::string Interpreter::system_name() const { return name({'G', system_code(modes_.system)}); }

std::vector<std::string> Interpreter::describe() const {
  const Axes program = to_program(machine_);
  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("motion mode {}, plane {}, {}, {}, arc centres {}",
                  name({'G', modes_.motion}),
                  name({'G', modes_.plane}),
                  modes_.inches ? "inches (G20)" : "millimetres (G21)",
                  modes_.incremental ? "incremental (G91)" : "absolute (G90)",
                  modes_.absolute_centres ? "absolute (G90.1)" : "incremental (G91.1)"));
  if (modes_.feed_mode == FeedMode::inverse_time) {
    lines.push_back("feed: inverse time (G93)");
  } else {
    lines.push_back(fmt::format("feed: {:.6g} mm/min (G94)", modes_.feed));
  }
  lines.push_back(
      fmt::format("work offset {}: origin X{:.6g} Y{:.6g} Z{:.6g} mm, rotated by {:.6g} degrees",
                  system_name(),
                  frame_.origin[0],
                  frame_.origin[1],
                  frame_.origin[2],
                  frame_.rotation_deg));
  lines.push_back(fmt::format("G92/G52 offset: X{:.6g} Y{:.6g} Z{:.6g} mm",
                              frame_.offset[0],
                              frame_.offset[1],
                              frame_.offset[2]));
  lines.push_back(fmt::format(
      "position: program X{:.6g} Y{:.6g} Z{:.6g} mm, machine X{:.6g} Y{:.6g} Z{:.6g} mm",
      program[0],
      program[1],
      program[2],
      machine_[0],
      machine_[1],
      machine_[2]));
  return lines;
}

}  // namespace chaintrue::gcode
