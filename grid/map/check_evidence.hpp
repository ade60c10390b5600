// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence of new readings for each hypothesis of a change, for any mechanism and kind of
/// reading. Private to grid.
///
/// Each hypothesis predicts the residuals r (measured less what was calibrated) with a covariance
///
///   K + X P X',   K = N + S S' + F F' of reading_covariance.hpp                              (1)
///
/// X is the effect of the changed quantities on r, P their prior covariance. F F' is the covariance
/// of the calibration. If the size of the noise is known
///
///   log p = -1/2 log|V| - 1/2 r' V^-1 r,                V = K + X P X'                        (2)
///
/// and where it was found from nu checks, K being known up to its factor,
///
///   log p = -1/2 log|V| - (n + nu)/2 log(1 + r' V^-1 r / nu)                                  (3)
///
/// Probabilities follow from the priors by Bayes' theorem. For a quantity that can only grow half
/// of its Gaussian counts (2 Phi(mean / sigma) of its posterior).
///
/// Sources: D. MacKay, Information Theory, Inference, and Learning Algorithms (2003), chapter 28, for
/// evidences; A. O'Hagan and J. Forster, Bayesian Inference (2004), section 11.3, for (3).
#pragma once

#include <Eigen/SparseCore>
#include <functional>
#include <string>
#include <vector>

#include "grid/map/check.hpp"
#include "grid/map/reading_covariance.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// For N places with m lengths each.
struct CheckReadings {
  VectorXd residual_mm;          ///< n
  ReadingCovariance covariance;  ///< K
  /// nu; infinite: the noise is known.
  double noise_dof = kInfinity;
  /// n x m N: derivatives by a change of each length's readings at each place.
  Eigen::SparseMatrix<double> by_length;
  std::size_t lengths = 2;      ///< m
  VectorXd lengths_mm;          ///< m N
  std::vector<double> zero_mm;  ///< as calibrated, m; empty if zeros are not settings
  MatrixXd by_parameter;        ///< n x p; no columns if nothing is known about parameters
  std::vector<model::MechanismChange> changes;
  std::vector<CheckUnit> units;    ///< in the order of the rows of `covariance`
  std::vector<std::string> names;  ///< of the rows
  std::vector<std::string> notes;  ///< corrections of the readings, and those that failed
};

/// In this order: nothing, the mechanism's changes, an unknown change, and each unit as a single bad one.
std::vector<CheckHypothesis> weighed_hypotheses(const CheckReadings& readings);

// The verdict of a check with its probability and sentences, from the hypotheses' probabilities.
// Private to grid.

/// A check's words for the calibration, the readings, and changes of the mechanism.
struct CheckWords {
  std::string subject;   ///< "the map"
  std::string readings;  ///< "points"
  std::string valid;     ///< "The map is still valid"
  std::string rezero;    ///< "The map is valid after re-zeroing"
  std::string again;     ///< "The map must be measured again"
  /// A change of the mechanism's as a clause: "the zero of the left chain has shifted by +1.00 mm".
  std::function<std::string(const CheckHypothesis&)> change;
  /// Follows `rezero`; empty: none.
  std::function<std::string(const Check&)> what_to_set = {};
};

Check judged(const CheckReadings& readings, const CheckWords& words);

}  // namespace chaintrue::grid
