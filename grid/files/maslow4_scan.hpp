// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The runs of a Maslow 4's log, before they are interpreted. Private to grid/files.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/maslow4_failure.hpp"
#include "grid/files/maslow4_readings.hpp"

namespace chaintrue::grid::files {

struct ScannedRun {
  std::string heading;
  bool is_list = false;  ///< printed as CLBM:[...]
  /// By waypoint; those that are not readable keep their place.
  std::vector<ScannedReading> points;
  std::map<int, model::BedPoint> commanded;  ///< by waypoint
  std::map<int, model::PerBelt<std::vector<double>>> thrown_away_mm;
  /// Single readings of the last attempt at a waypoint.
  std::map<int, model::PerBelt<std::vector<double>>> last_attempt_mm;
  std::optional<FirmwareFit> fit;
  std::optional<double> pull_ma;  ///< the motors' current, where the log prints the setting before
  int last_measured = -1;   ///< of "Measured waypoint N"; -1: the log has none
  int last_announced = -1;  ///< of "Waypoints [0-N]"
  /// The list has fewer readings than waypoints were measured before it was printed.
  bool list_is_short = false;
  std::size_t first_line = 0;
};

struct ScannedLog {
  std::vector<ScannedRun> runs;       ///< with a reading that can be read, or that cannot
  std::optional<RunStopped> stopped;  ///< how the last run ended, if it did not finish
  std::optional<SettingsRefused> refused;  ///< the first setting that the controller rejected
  std::optional<std::size_t> first_passed_over;  ///< the first line from which nothing is read
  bool list_has_end = true;           ///< false: the log ends in the middle of a list
};
/// `file` is the name used in messages.
[[nodiscard]] ScannedLog scan_maslow4(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
