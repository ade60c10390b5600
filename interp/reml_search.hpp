// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The minimiser of V over theta: a coarse scan, then Newton with a bounded step. Internal to
/// interp.

#include <vector>

#include "interp/reml_marginal.hpp"

namespace chaintrue::interp::reml {

struct SearchResult {
  Eigen::VectorXd theta;
  Eigen::VectorXd low;  ///< the search's limits
  Eigen::VectorXd high;
  std::vector<SmoothingEnd> ends;  ///< one for each penalty
  int iterations = 0;
};

[[nodiscard]] tl::expected<SearchResult, FitFailure::Reason> search(const Marginal& marginal,
                                                                    int maximum_iterations);

/// The covariance of theta from the Hessian of V (twice the information). The rows and columns of
/// unknowns that ended at a limit are zero.
[[nodiscard]] Eigen::MatrixXd covariance_from_hessian(const Eigen::MatrixXd& hessian,
                                                      const std::vector<SmoothingEnd>& ends);

}  // namespace chaintrue::interp::reml
