// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The runs of a Maslow 4's log, before they are interpreted. Private to grid/files.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct ScannedPoint {
  model::PerBelt<double> lengths_mm;
  std::size_t line = 0;
};

struct ScannedRun {
  std::string heading;
  bool is_list = false;  ///< printed as CLBM:[...]
  std::vector<ScannedPoint> points;
  std::map<int, model::BedPoint> commanded;  ///< by waypoint
  std::map<int, model::PerBelt<std::vector<double>>> thrown_away_mm;
  std::optional<FirmwareFit> fit;
};

/// Runs with readings. Problems with a reading, and a list without an end, are reported.
[[nodiscard]] std::vector<ScannedRun> scan_maslow4(const std::string& text, Problems& problems);

}  // namespace chaintrue::grid::files
