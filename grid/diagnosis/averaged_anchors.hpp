// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors of four belts averaged over the models of a comparison, weighted by probability:
/// each cause of yielding under the pull, with every other cause and sets of causes, with and
/// without a smooth pattern. Private to grid/diagnosis.
///
/// With anchors a_m, covariance C_m and weight w_m of model m, together 1:
///
///   a = sum_r w_r a_r / sum_r w_r,   C = sum_m w_m (C_m + (a_m - a)(a_m - a)')              (1)
///
/// where r are the models of exactly the causes that are reported: anchors are used with these, and a mean over all would
/// fit the readings with none of them. C is the expected square of the anchors' error.
///
/// w_m is the evidence of the comparison with another prior. A diagnosis treats each cause as rare;
/// a sigma has to hold if one acts at its usual size, so each gets the weight that gives 95 %
/// intervals their coverage then (kWeights, found by tests/lab/sealed/command/anchor_coverage).
/// Causes about which the state is linear keep their fitted sizes, however unusual; all others have
/// their usual spread.
///
/// Source: J. Hoeting, D. Madigan, A. Raftery and C. Volinsky, Bayesian Model Averaging, Statist.
/// Sci. 14 (1999) 382, equations 1 and 2.
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/belts_system.hpp"

namespace chaintrue::grid::diagnosis {

/// A cause with its values, the sigma of the first, and its probability.
struct AveragedCause {
  SizedCause cause;
  double sigma = 0.0;
  double probability = 0.0;
};

struct AveragedAnchors {
  belts::AnchorVector anchors = belts::AnchorVector::Zero();
  Eigen::Matrix<double, belts::kAnchorUnknowns, belts::kAnchorUnknowns> covariance_mm2 =
      Eigen::Matrix<double, belts::kAnchorUnknowns, belts::kAnchorUnknowns>::Zero();
  /// The likeliest cause of yielding under the pull, and all others that are more likely than not;
  /// sizes averaged over the models that contain them.
  std::vector<AveragedCause> causes;
};

/// \pre the system is linear about these anchors. \throws std::invalid_argument for a comparison without a
/// model.
AveragedAnchors averaged_anchors(const belts::AnchorVector& about, const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
