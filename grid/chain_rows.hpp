// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The index of a chain in a pair of rows or numbers: left, right.
#pragma once

#include "grid/eigen.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid {

constexpr Index row_of(model::Side side) { return side == model::Side::left ? 0 : 1; }

}  // namespace chaintrue::grid
