// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a compensation map is compared by, in words and numbers.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "tools/cli/settings_table.hpp"

namespace chaintrue::cli {

/// A length for a headline: one digit below a millimetre ("0.3 mm", "0.04 mm"), two above ("5.1 mm",
/// "11 mm").
[[nodiscard]] std::string about_mm(double mm);

/// What a page calls error_in_use(): the one number that every verb and page means by "before".
inline constexpr const char* kToolTodayLabel =
    "error of the tool today, rms over the measured part";

/// What makes the difference, in the words of a headline.
struct Remedy {
  std::string_view with;    ///< "this map"
  std::string_view needed;  ///< "map": "Your machine needs no map"
};
/// "Your machine misses by about 4.9 mm. With this map it misses by about 0.2 mm." `today_mm` is unknown
/// where nobody said what the machine goes by.
[[nodiscard]] std::string misses_sentence(std::optional<double> today_mm,
                                          double expected_mm,
                                          const Remedy& remedy);
/// "At worst it misses by about 0.7 mm, in 95 of 100 sessions. It is least sure near (1118, 508)."
[[nodiscard]] std::string worst_sentence(double x_mm, double y_mm, double worst_mm);

/// The headline: by how much the tool misses today, and by how much with the map. Both are errors of
/// the tool over the measured part, not what is left at the points.
[[nodiscard]] std::string fit_sentence(const grid::CompensationMap& map);

/// The statistics of the points: rms with the settings in force, with the map, and of points left out.
[[nodiscard]] std::string points_sentence(const grid::CompensationMap& map);

/// Whether the map is as good as was wished, and if not, how many marks would be expected to do it.
[[nodiscard]] std::string wish_sentence(const grid::CompensationMap& map, double wish_mm);

/// Machines that nobody calibrated are this far off, once their sheet is laid.
inline constexpr double kMostToCutWithMm = 3.0;
/// Why nothing is to be cut with this map: left out, its own points come back more than that off, rms.
/// Empty of any other. gcode compensate and export take such a map with --force alone.
[[nodiscard]] std::string not_to_cut_with(const grid::CompensationMap& map);

/// Says so, and what takes it all the same; false where it may be cut with.
[[nodiscard]] bool refuses_to_cut_with(const grid::CompensationMap& map);

using Residual = Eigen::Vector2d grid::MapPoint::*;
/// Over the good points.
[[nodiscard]] grid::ErrorSummary summary_of(const grid::MapContents& contents, Residual residual);
/// Whether the sheet was laid by hand, and its place found.
[[nodiscard]] bool has_placed_sheet(const grid::MapContents& contents);
/// What the map is held against, and its name: the machine as stated, the sheet found.
[[nodiscard]] Residual residual_before(const grid::MapContents& contents);
[[nodiscard]] std::string_view machine_before(const grid::MapContents& contents);
/// Of the machine and of the sheet.
[[nodiscard]] std::vector<SettingRow> settings_rows(const grid::CompensationMap& map);

}  // namespace chaintrue::cli
