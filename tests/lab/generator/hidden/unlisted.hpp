// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Disturbances that are in no catalogue: positions where the board or the frame under the sled
/// moves the bit off its mark.
#include "generator/hidden/disturbance.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::generator {

/// The tool's shift at a place, for a size of 1 mm at its maximum or per its own unit: a dent that the sled tips into, a
/// wavy board, a fold, an edge over which the sled's rim drops, a wave along x.
std::function<Vec2(Vec2)> draw_oddity(Dice& dice);

}  // namespace chaintrue::generator
