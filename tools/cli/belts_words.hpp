// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts in words and numbers.
#pragma once

#include <string>

#include "grid/belts/belts_fit.hpp"

namespace chaintrue::cli {

/// Spread, anchors, what was foretold and set aside, and the scale.
[[nodiscard]] std::string belts_fit_in_words(const grid::MeasuredBelts& belts,
                                             const grid::BeltsFit& fit);
/// Each place with what its belts are off by.
[[nodiscard]] std::string places_in_a_table(const grid::BeltsFit& fit);

}  // namespace chaintrue::cli
