// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence for laws: how probable the readings are if one of them acts, whatever its amplitudes,
/// place or period, together with the causes that lead the comparison and with each smooth discrepancy
/// or none; against the same without a law.
///
///   P(law l | y) = sum_{theta, S, D} W(l, theta, S, D) / (W0 + sum of all W)
///   W = prior(S, D) kLawPrior share_l mass_theta p(y | l, theta, S, D),  W0 = sum prior(S, D) p(y | S, D)
///
/// p is set_evidence() (evidence.hpp) with a law's amplitudes as further columns: their prior is that of
/// a cause's strength. theta lies on the grid of the curve (law_curves.hpp), refined about the
/// leading points (trapezoids). Two passes: all laws in the few leading contexts (S, D) without a
/// law; then the leading laws in every context with a share given one of them.
#pragma once

#include <cstddef>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/law_curves.hpp"
#include "grid/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// One law at one point of its grid, over all contexts.
struct WeighedLaw {
  std::size_t curve = 0;
  double at = 0.0;          ///< as LawCurve::grid
  double log_weight = 0.0;  ///< mass of the point included
  std::size_t set = 0;      ///< of the best context, into LawEvidence::sets
  int discrepancy = -1;
  VectorXd amplitude;   ///< given the best context
  MatrixXd covariance;  ///< of these
};

struct LawEvidence {
  std::vector<LawCurve> curves;
  std::vector<RegressorSet> sets;  ///< of the system's regressors
  std::size_t marginalised = 0;    ///< in which they were weighed
  double log_without = 0.0;        ///< no law acts
  std::size_t without_set = 0;     ///< in the best context of these
  int without_discrepancy = -1;
  std::vector<WeighedLaw> laws;  ///< those with a share, heaviest first
  /// Logarithm of all weights together.
  double log_total() const;
};

/// In one of the comparison's marginalised systems. `curves` with their shares.
LawEvidence weigh_laws(const Analysis& analysis, std::size_t marginalised,
                       std::vector<LawCurve> curves);

}  // namespace chaintrue::grid::diagnosis
