// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a compensation map is compared by, in words and numbers.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "tools/cli/settings_table.hpp"

namespace chaintrue::cli {

/// One sentence: how far the tool was off before, and what is left.
[[nodiscard]] std::string fit_sentence(const grid::CompensationMap& map);

/// Why nothing is to be cut with this map: left out, its own points come back more than 3 mm rms
/// off. Empty of any other. gcode compensate and export take such a map with --force alone.
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
