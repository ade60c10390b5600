// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Partial residuals of a law: at each point the law plus the unexplained residual, in the
/// coordinate that it enters.
///
///   z_i = law(v_i) + c_i'r_i / c_i'c_i
///   c   rows of the point for one millimetre of the law,  r  noise (law_model.hpp)
///
/// If the law is right, points scatter about the curve as the readings do.
#pragma once

#include <optional>
#include <vector>

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

// The error of predicting left-out readings with a law, compared with the settings, the
// causes and the best smooth pattern without one.
//
//   e_i^ = C_ik C_kk^-1 e_k,   C as in law_model.hpp, k the rows that are kept, i those left out
//
// Inside: every fourth of the places, four times, so that neighbours stay. Outside: the quarters
// of the bed on one side of a line (bed_parts.hpp), left out whole. Every distance that ends at
// such a place is left out: others would determine its hole. Sizes are estimated anew each time,
// and the place or period is chosen anew among the leading values of its grid; shape and entry
// stay.
//
// Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equation 2.25.

/// The points of one curve, the heaviest first.
using LawPoints = std::vector<const WeighedLaw*>;

/// For the law at one of the points of its curve; absent if no parts of the bed can be left out.
std::optional<LawHeldOut> held_out_with(const Analysis& analysis, const WeighedLaw& law,
                                        const LawPoints& of_curve);

/// The probability of a law averaged over parts of the bed, as that of causes given a pattern is
/// (bed_parts.hpp): a real pattern follows no law exactly, and a slightly wrong likelihood gives
/// large odds from a few marks. A true law holds without any quarter of the bed.
///
///   odds_k = odds (f r_k - r),   r = log p(e | law, S, D) - log p(e | S0, D0)
///
/// r_k without quarter k, f the share of rows that it counts for; S, D and S0, D0 the best contexts with the
/// law and without one. The result is the mean of the probabilities, and no more than that of all readings.
/// (J. Huggins and J. Miller, Bayesian Analysis 18 (2023) 79.)

/// `probability` is that of all readings; it is returned if there are no such parts.
double averaged_over_parts(const Analysis& analysis, const WeighedLaw& law, double probability);

/// For the points that are kept whole, in the order of the files; `law` with the parameters of `weighed`.
std::vector<LawResidual> residuals_about(const Analysis& analysis, const WeighedLaw& weighed,
                                         const Law& law);

}  // namespace chaintrue::grid::diagnosis
