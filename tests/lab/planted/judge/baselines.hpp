// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Textbook methods of variable selection on the columns that the diagnosis has, settings and sheet taken
/// out: what a person with a statistics package would get from the same data.
///
/// Each gives every cause a score, larger where it is surer; a threshold on it gives names. A cause has
/// several columns, one for each place where it may set in.
///
/// Sources: N. Draper and H. Smith, Applied Regression Analysis (1998), chapter 15 (stepwise); G. Schwarz,
/// Annals of Statistics 6 (1978) 461 (BIC); R. Tibshirani, J. R. Stat. Soc. B 58 (1996) 267 and J. Friedman,
/// T. Hastie and R. Tibshirani, J. Stat. Software 33 (2010) 1 (LASSO by coordinate descent).
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

namespace chaintrue::planted {

struct Regression {
  Eigen::VectorXd y;                ///< in units of the stated noise
  Eigen::MatrixXd columns;          ///< none of length zero
  std::vector<std::string> causes;  ///< of each column
  int taken = 0;                    ///< degrees of freedom that settings and sheet have taken
};
using Scores = std::map<std::string, double>;  ///< causes that are not in it are never named

/// Forward steps, each followed by backward ones, at F of 2, 2.8, 4, ... to enter and to leave. Score:
/// the largest F at which the cause is in the model.
[[nodiscard]] Scores stepwise_scores(const Regression& data);

/// All sets of at most three causes, each at its eight best places, weighed by exp(-BIC/2); the noise is what
/// the set leaves. Score: the sum of the weights of the sets that hold the cause.
[[nodiscard]] Scores bic_scores(const Regression& data);

/// LASSO at the penalty of the least error of ten folds, each of consecutive rows. Score: the length of
/// what the cause's columns add, in units of the noise that is left.
[[nodiscard]] Scores lasso_scores(const Regression& data);

}  // namespace chaintrue::planted
