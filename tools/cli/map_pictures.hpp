// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the pictures of a compensation map show.
#pragma once

#include "grid/map/compensation_map.hpp"
#include "tools/report/map_pictures.hpp"

namespace chaintrue::cli {

[[nodiscard]] report::MapPictures map_pictures(const grid::CompensationMap& map);

}  // namespace chaintrue::cli
