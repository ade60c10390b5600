// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A smooth trend through readings with some or many gross errors.
///
///   r_i = B_i beta + e_i,   e_i ~ multivariate Cauchy of scale s,   beta_j ~ N(0, sigma_j^2)   (1)
///
/// r_i has one or two components; beta and s maximise the posterior, by the EM steps of Student's t
/// with one degree of freedom (K. Lange, R. Little and J. Taylor, J. Am. Stat. Assoc. 84 (1989)
/// 881). Accounts of the same readings are compared by their log-likelihoods.
#pragma once

#include "interp/eigen.hpp"

namespace chaintrue::grid::input_checks {

/// B and r of (1).
struct TrendRows {
  MatrixXd basis;
  MatrixXd off_mm;
};

struct RobustTrend {
  MatrixXd coefficients;  ///< (basis, component)
  VectorXd residual_mm;   ///< |r_i - B_i beta|; infinity for a missing row
  double scale_mm = 0.0;  ///< s
  double log_likelihood =
      0.0;  ///< at the maximum of (1), with the prior's factor relative to beta = 0
  double prior_chi_square = 0.0;  ///< sum_j (beta_j / sigma_j)^2
  /// For the rows that are not missing; infinity if all are.
  double median_residual_mm() const;
};

/// A row that is not finite is missing and counts as uniform over the bed. \pre as many rows of
/// basis as of readings, all sigmas positive.
RobustTrend robust_trend(const TrendRows& rows, const VectorXd& prior_sigma_mm);

/// Log-likelihood of a reading that is off by this, relative to an exact one.
double log_density_of(double residual_mm, double scale_mm, Index components);

}  // namespace chaintrue::grid::input_checks
