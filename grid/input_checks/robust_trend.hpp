// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A smooth trend through readings of which some, or many, are grossly wrong.
///
///   r_i = B_i beta + e_i,   e_i ~ multivariate Cauchy of scale s,   beta_j ~ N(0, sigma_j^2)   (1)
///
/// r_i has one or two components; beta and s maximise the posterior, by the EM steps of Student's t
/// with one degree of freedom (K. Lange, R. Little and J. Taylor, J. Am. Stat. Assoc. 84 (1989)
/// 881). Of two accounts of the same readings the one with the larger log-likelihood is the better,
/// whatever its rows are made of.
#pragma once

#include <Eigen/Core>

namespace chaintrue::grid::input_checks {

struct RobustTrend {
  Eigen::MatrixXd coefficients;   ///< (basis, component)
  Eigen::VectorXd residual_mm;         ///< |r_i - B_i beta|; of a row that is missing infinity
  double scale_mm = 0.0;          ///< s
  double log_likelihood = 0.0;    ///< of (1) at its maximum, the prior's factor relative to beta = 0
  double prior_chi_square = 0.0;  ///< sum_j (beta_j / sigma_j)^2
  /// Of the rows that are not missing; infinity where all are.
  [[nodiscard]] double median_residual_mm() const;
};

/// A row that is not finite is missing, and counts as one that is anywhere on the bed. \pre as many
/// rows of basis as of readings, all sigmas positive.
[[nodiscard]] RobustTrend robust_trend(const Eigen::MatrixXd& basis,
                                       const Eigen::VectorXd& prior_sigma_mm,
                                       const Eigen::MatrixXd& readings_mm);

/// Of one reading that is off by this, relative to one that is not off at all.
[[nodiscard]] double log_density_of(double residual_mm, double scale_mm, Eigen::Index components);

}  // namespace chaintrue::grid::input_checks
