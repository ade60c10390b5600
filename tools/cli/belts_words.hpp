// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fit of four belts, and what a diagnosis makes of them, in words and numbers.
#pragma once

#include <string>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/belts_and_holes.hpp"
#include "grid/diagnosis/diagnosis.hpp"

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

/// Anchors before and with the causes, what the lower belts were foretold to be, and the tool.
[[nodiscard]] std::string diagnosed_belts_in_words(const grid::diagnosis::BeltsFindings& found);
/// "the top left belt at point 17: read 80.2 mm too long (31.0 sigmas)"
[[nodiscard]] std::string bad_belt_in_words(const grid::diagnosis::Outlier& bad);

}  // namespace chaintrue::cli
