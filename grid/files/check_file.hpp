// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a check as JSON, for scripts. Written only. Same check, same bytes.
#pragma once

#include <string>

#include "grid/map/check.hpp"

namespace chaintrue::grid::files {

/// For a compensation map: zeros and elongations by chain, a residual each.
[[nodiscard]] std::string write_map_check(const Check& check);
/// For anchors: the size of what has changed, a place each.
[[nodiscard]] std::string write_anchors_check(const Check& check);

}  // namespace chaintrue::grid::files
