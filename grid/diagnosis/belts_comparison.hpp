// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence of four belts' lengths for nothing, for causes and for causes together, alone and
/// beside a pattern that nobody listed: what is left of each belt's lengths changes smoothly from
/// place to place. Private to grid/diagnosis.
///
///   cov(f_b(p), f_c(q)) = s^2 exp(-|p - q|^2 / (2 l^2))  for b = c, else 0                  (1)
///
/// f_b is added to the readings of belt b; a place's two checks see Q' f. Each length l is tried at
/// some strengths, s such that the pattern is expected to be so many sigmas long in the checks once
/// the anchors have taken their share. Rows that are whitened by V = I + (1) are a system like any
/// other, with the pattern integrated out.
///
/// A cause's size is beforehand about nothing with the spread that its parameter has (prior_sigma),
/// with a small weight five times that: a belt's zero that only shows from 40 mm on is no likelier
/// for it. Source: evidence.hpp.
#pragma once

#include "grid/diagnosis/belts_analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// All of it, or what a first look needs: the best set of units, every other strength.
enum class Look { first, whole };

/// Sets the analysis' comparison, each of these sets of units set aside in turn. A pattern is numbered
/// length by length and strength by strength in CandidateModel::discrepancy.
void compare_belts(const std::vector<std::vector<bool>>& sets, Look look, BeltsAnalysis& analysis);

/// With the pattern of the decision integrated out of system and comparison from here on: sizes,
/// sigmas and what is said of other causes are then beside it. Nothing where the decision has none.
void integrate_pattern(BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
