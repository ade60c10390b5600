// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a check of a map as JSON, for scripts. Written only. Same check, same bytes.
#pragma once

#include <string>

#include "grid/belts/anchors_check.hpp"
#include "grid/map/map_check.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] std::string write_check(const AnchorsCheck& check);
[[nodiscard]] std::string write_check(const MapCheck& check);

}  // namespace chaintrue::grid::files
