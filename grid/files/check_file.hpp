// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a check as JSON, for scripts. Written only. Same check, same bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "grid/map/check.hpp"
#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid::files {

/// For a compensation map: zeros and elongations by chain, a residual each.
std::string write_map_check(const Check& check);
/// For anchors: the size of what has changed, a place each.
std::string write_anchors_check(const Check& check);

// The report of a fit as JSON, for scripts; the map itself is in its own file. Written only. Same
// map, same bytes.

/// `wish_mm`: the error of the tool that was wished for.
std::string write_fit(const CompensationMap& map, std::string_view sentence,
                      std::optional<double> wish_mm = std::nullopt);

}  // namespace chaintrue::grid::files
