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

#include <memory>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/law_curves.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// What acts besides a law.
struct ActsBesides {
  RegressorSet causes;
  int discrepancy = -1;
};

/// One law at one point of its grid, over all contexts.
struct WeighedLaw {
  std::size_t marginalised = 0;           ///< of the comparison's systems, in which it was weighed
  std::shared_ptr<const LawCurve> curve;  ///< one for all its points
  double at = 0.0;                        ///< as LawCurve::grid
  double mass = 0.0;                      ///< prior of the point, among those of the curve
  double log_weight = 0.0;                ///< mass of the point included
  ActsBesides with{};                     ///< in the best context
  ActsBesides without{};                  ///< in the best context if no law acts
  VectorXd amplitude{};                   ///< given the best context
  MatrixXd covariance{};                  ///< of these

  /// There is one column for each amplitude, in all rows.
  MatrixXd columns(const RegressorSystem& system) const {
    return law_columns(system, *curve, {at});
  }
  /// What it adds to all rows.
  VectorXd rows(const RegressorSystem& system) const { return columns(system) * amplitude; }
};

/// Refers to one of the comparison's marginalised systems.
struct LawEvidence {
  double log_without = 0.0;      ///< no law acts
  std::vector<WeighedLaw> laws;  ///< those with a share, heaviest first
};

/// `curves` with their shares.
LawEvidence weigh_laws(const Analysis& analysis, std::size_t marginalised,
                       std::vector<LawCurve> curves);

}  // namespace chaintrue::grid::diagnosis
