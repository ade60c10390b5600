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

#include <vector>

#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// For the points that are kept whole, in the order of the files; `law` with the parameters of `weighed`.
[[nodiscard]] std::vector<LawResidual> residuals_about(const Analysis& analysis,
                                                       const LawEvidence& evidence,
                                                       const WeighedLaw& weighed,
                                                       const Law& law);

}  // namespace chaintrue::grid::diagnosis
