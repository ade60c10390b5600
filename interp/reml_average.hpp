// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The posterior averaged over theta instead of evaluated at its optimum (internal to interp;
/// notation as in reml.hpp and reml_marginal.hpp).

#include "interp/reml_search.hpp"

namespace chaintrue::interp::reml {

struct Averaged {
  Eigen::MatrixXd covariance;      ///< q x q, in the problem's columns
  Eigen::VectorXd inverse_lambda;  ///< K
};

/// The posterior covariance of b about the fit with theta averaged over rather than fixed: E[A^-1] +
/// E[(b - fit)(b - fit)']. What each lambda adds to A^-1 is added up; where sigma2 is free each
/// lambda is averaged together with it. `sigma` is one standard error of each theta.
[[nodiscard]] Averaged averaged_covariance(const Marginal& marginal,
                                           const SearchResult& found,
                                           const Eigen::VectorXd& sigma);

}  // namespace chaintrue::interp::reml
