// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of YAML that FluidNC's settings use: keys by their indentation, and the value after the
/// colon. Private to grid/files.
#pragma once

#include <map>
#include <string>

namespace chaintrue::grid::files {

struct YamlValue {
  std::string text;
  std::string place;  ///< "line 4"
};

/// Values by their path: "kinematics/WallPlotter/left_anchor_x".
[[nodiscard]] std::map<std::string, YamlValue> yaml_values(const std::string& text);

}  // namespace chaintrue::grid::files
