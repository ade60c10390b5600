// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// As much of YAML as FluidNC's settings have: keys by their indentation, and what stands behind the
/// colon. Private to grid/files.
#pragma once

#include <map>
#include <string>

namespace chaintrue::grid::files {

struct YamlValue {
  std::string text;
  std::string place;  ///< "line 4"
};

/// Values by the way to them: "kinematics/WallPlotter/left_anchor_x".
[[nodiscard]] std::map<std::string, YamlValue> yaml_values(const std::string& text);

}  // namespace chaintrue::grid::files
