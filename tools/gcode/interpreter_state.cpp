// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The interpreter's state as parameters (#<_x> ..) and in words.
#include <fmt/format.h>

#include <utility>

#include "tools/gcode/interpreter.hpp"

namespace chaintrue::gcode {

Axes Interpreter::position() const {
  Axes place = to_program(machine_);
  for (const std::size_t axis : {0U, 1U, 2U}) place[axis] /= mm_per_unit();
  return place;
}

std::optional<double> Interpreter::state(std::string_view name) const {
  if (!name.starts_with('_')) return std::nullopt;
  const Axes here = position();
  const bool per_minute = modes_.feed_mode == FeedMode::per_minute;
  const std::pair<std::string_view, double> values[] = {
      {"_x", here[0]},
      {"_y", here[1]},
      {"_z", here[2]},
      {"_a", here[3]},
      {"_b", here[4]},
      {"_c", here[5]},
      {"_metric", !modes_.inches},
      {"_imperial", modes_.inches},
      {"_absolute", !modes_.incremental},
      {"_incremental", modes_.incremental},
      {"_ijk_absolute_mode", modes_.absolute_centres},
      {"_inverse_time", !per_minute},
      {"_units_per_minute", per_minute},
      {"_units_per_rev", 0.0},
      {"_motion_mode", modes_.motion},
      {"_plane", modes_.plane},
      {"_coord_system", system_code(modes_.system)},
      {"_retract_r_plane", modes_.retract_to_r},
      {"_retract_old_z", !modes_.retract_to_r},
      {"_spindle_on", modes_.spindle != 0},
      {"_spindle_cw", modes_.spindle == 3},
      {"_feed", per_minute ? modes_.feed / mm_per_unit() : modes_.feed},
      {"_rpm", modes_.spindle_rpm},
      {"_current_tool", modes_.tool},
      {"_selected_tool", modes_.selected_tool},
      {"_call_level", call_level_},
  };
  for (const auto& [known, value] : values) {
    if (known == name) return value;
  }
  return std::nullopt;
}

std::string Interpreter::system_name() const { return name({'G', system_code(modes_.system)}); }

std::vector<std::string> Interpreter::describe() const {
  const auto place = [](const Axes& axes) {
    return fmt::format("X{:.6g} Y{:.6g} Z{:.6g}", axes[0], axes[1], axes[2]);
  };
  std::vector<std::string> lines;
  lines.push_back(
      fmt::format("motion mode {}, plane {}, {}, {}, arc centres {}", name({'G', modes_.motion}),
                  name({'G', modes_.plane}), modes_.inches ? "inches (G20)" : "millimetres (G21)",
                  modes_.incremental ? "incremental (G91)" : "absolute (G90)",
                  modes_.absolute_centres ? "absolute (G90.1)" : "incremental (G91.1)"));
  if (modes_.feed_mode == FeedMode::inverse_time) {
    lines.push_back("feed: inverse time (G93)");
  } else {
    lines.push_back(fmt::format("feed: {:.6g} mm/min (G94)", modes_.feed));
  }
  lines.push_back(fmt::format("work offset {}: origin {} mm, rotated by {:.6g} degrees",
                              system_name(), place(frame_.origin), frame_.rotation_deg));
  lines.push_back(fmt::format("G92/G52 offset: {} mm", place(frame_.offset)));
  lines.push_back(fmt::format("position: program {} mm, machine {} mm", place(to_program(machine_)),
                              place(machine_)));
  return lines;
}

}  // namespace chaintrue::gcode
