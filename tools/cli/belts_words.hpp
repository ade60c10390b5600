// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts in words and numbers.
#pragma once

#include <string>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/belts_and_holes.hpp"

namespace chaintrue::cli {

/// Spread, anchors, what was foretold and set aside, and the scale.
[[nodiscard]] std::string belts_fit_in_words(const grid::MeasuredBelts& belts,
                                             const grid::BeltsFit& fit);
/// How well the distances agree, what was set aside, and how far the tool lies beside its belts.
[[nodiscard]] std::string holes_beside_belts_in_words(const grid::HolesBesideBelts& holes);
/// Each distance with what it is off by.
[[nodiscard]] std::string taped_in_a_table(const grid::HolesBesideBelts& holes);
/// Each place with what its belts are off by.
[[nodiscard]] std::string places_in_a_table(const grid::BeltsFit& fit);

}  // namespace chaintrue::cli
