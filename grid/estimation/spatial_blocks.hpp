// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Splits points into compact blocks of the bed, so that neighbours do not make held-out errors too
/// small.
#pragma once

#include <vector>

#include "grid/containers.hpp"
#include "grid/observation/length_points.hpp"

namespace chaintrue::grid {

/// Indices into `points`, about eight blocks: four columns by the points' x, each split in two by
/// its points' y. Each block is ascending; together they hold every point once.
std::vector<Indices> spatial_blocks(const std::vector<LengthPoint>& points);

}  // namespace chaintrue::grid
