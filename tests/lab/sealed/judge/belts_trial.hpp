// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The diagnosis of one hidden session of four belts, compared with the truth.
#pragma once

#include <cstdint>
#include <string>

#include "generator/hidden/belt_draw.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// The owner's view of it.
grid::MeasuredBelts measured_belts_of(const generator::BeltDraw& draw);
/// With the facts of the table of rates; `more` adds
///   separable  at its strength these data distinguish the hidden cause from every other in 95 of 100 cases,
///              by their collinearity after projection on the anchors
///   one_belt   it acts on one belt, and something is named
///   set        a set of causes is named, or several
///   wrong      one cause is named, and another is hidden
[[nodiscard]] Outcome run_belts_trial(const std::string& kind, const generator::BeltRecipe& recipe,
                                      std::uint64_t seed, bool more = false);

}  // namespace chaintrue::sealed
