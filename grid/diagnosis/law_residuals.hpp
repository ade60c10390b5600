// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Partial residuals of a law: what the law makes at each point and what nothing explains there, in the
/// measure in which it enters.
///
///   z_i = law(v_i) + c_i'r_i / c_i'c_i
///   c   rows of the point for one millimetre of the law,  r  noise (law_model.hpp)
///
/// Points about the curve scatter as the readings do, where the law is right.
#pragma once

#include <vector>

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Of the points that are kept whole, in the order of the files; `law` with the parameters of `weighed`.
[[nodiscard]] std::vector<LawResidual> residuals_about(const Analysis& analysis,
                                                       const LawEvidence& evidence,
                                                       const WeighedLaw& weighed,
                                                       const Law& law);

}  // namespace chaintrue::grid::diagnosis
