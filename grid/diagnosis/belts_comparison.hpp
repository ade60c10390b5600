// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence of four belts' lengths for nothing, for causes and for causes together, alone and
/// beside a pattern that nobody listed (belts_pattern.hpp).
///
/// A cause's size is beforehand about nothing with the spread that its parameter has (prior_sigma),
/// with a small weight five times that: a belt's zero that only shows from 40 mm on is no likelier
/// for it. Source: evidence.hpp.
#pragma once

#include "grid/diagnosis/belts_analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// All of it, or what a first look needs: the best set of units, every other strength.
enum class Look { first, whole };

/// Sets the analysis' comparison, each of these sets of units set aside in turn.
void compare_belts(const std::vector<std::vector<bool>>& sets, Look look, BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
