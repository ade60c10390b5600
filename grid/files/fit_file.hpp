// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The report of a fit as JSON, for scripts; the map itself is in its own file. Written only. Same
/// map, same bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid::files {

/// `wish_mm`: the error of the tool that was wished for.
[[nodiscard]] std::string write_fit(const CompensationMap& map,
                                    std::string_view sentence,
                                    std::optional<double> wish_mm = std::nullopt);

}  // namespace chaintrue::grid::files
