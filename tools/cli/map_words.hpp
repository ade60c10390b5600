// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map in the words of a workshop.
#pragma once

#include <string>
#include <string_view>

#include "grid/map/compensation_map.hpp"
#include "tools/cli/settings_table.hpp"

namespace chaintrue::cli {

/// One sentence: how far the tool was off before, and what is left.
[[nodiscard]] std::string fit_sentence(const grid::CompensationMap& map);
/// That, how far the tool will be off now, and what was odd: a few lines.
[[nodiscard]] std::string fit_in_words(const grid::CompensationMap& map);
/// The rest of the story: settings, errors of points left out, the mirror claim.
[[nodiscard]] std::string fit_in_tables(const grid::CompensationMap& map);
/// Of the machine and of the sheet.
[[nodiscard]] std::vector<SettingRow> settings_rows(const grid::CompensationMap& map);

}  // namespace chaintrue::cli
