// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A compensation map as the plain data of a report.
#pragma once

#include <string_view>

#include "grid/map/compensation_map.hpp"
#include "tools/report/map_report.hpp"

namespace chaintrue::cli {

/// `source` is the name of the map's file, as the page's last line gives it.
[[nodiscard]] report::MapReport map_report(const grid::CompensationMap& map,
                                           std::string_view source);

}  // namespace chaintrue::cli
