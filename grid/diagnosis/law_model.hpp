// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One explanation, possibly with a law: the covariance of the kept rows with the settings, the
/// sizes of causes and the amplitudes of a law integrated out.
///
///   C = 1 + S + s^2 K + sum_k p_k^2 g_k g_k',   S of the settings as stated, K of a discrepancy
///   r = C^-1 (e - m)   posterior mean of the noise in rows e, after subtracting m
///
/// \code
///   LawModel model(analysis, marginalised, {3, 7}, -1);
///   const Eigen::VectorXd noise = model.noise_of(law);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/law_evidence.hpp"

namespace chaintrue::grid::diagnosis {

class LawModel {
 public:
  /// `regressors` of the system; `discrepancy` -1 for none. Both arguments must outlive this.
  LawModel(const Analysis& analysis,
           const MarginalisedSystem& marginalised,
           const std::vector<int>& regressors,
           int discrepancy);

  /// Adds a column (all rows) of unknown amplitude.
  void add(const Eigen::VectorXd& column);

  /// For some of the kept rows, by their positions.
  [[nodiscard]] double log_density(const std::vector<Eigen::Index>& rows) const;
  /// For all kept rows, after subtracting `known` (all rows).
  [[nodiscard]] double log_density(const Eigen::VectorXd& known) const;

  /// The noise part of the kept rows and, with the discrepancy added, the machine's residual, after
  /// subtracting `known` (all rows).
  struct Left {
    Eigen::VectorXd noise;
    Eigen::VectorXd unexplained;
  };
  [[nodiscard]] Left left_of(const Eigen::VectorXd& known) const;

  /// For left-out kept rows, by their positions: the difference from the prediction by the others.
  [[nodiscard]] Eigen::VectorXd left_of_prediction(const std::vector<Eigen::Index>& rows,
                                                   const std::vector<Eigen::Index>& left_out) const;

  /// The prediction of other rows, whitened, from all kept ones: mean, and a square root of the
  /// covariance without their noise. `columns` of these rows: the regressors', then those added.
  ///   m = X* f + K* C^-1 (e - X f),  S = K** - K* C^-1 K*'
  /// C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equations 2.38 and 2.39.
  struct Expected {
    Eigen::VectorXd mean;
    Eigen::MatrixXd spread;
  };
  [[nodiscard]] Expected expected_of(const RegressorSystem& next, const Eigen::MatrixXd& columns) const;

 private:
  const RegressorSystem& system_;
  const MarginalisedSystem& marginalised_;
  double dof_;
  std::optional<Discrepancy> process_;
  Eigen::MatrixXd settings_;             ///< kept rows, scaled to one sigma each
  std::vector<Eigen::VectorXd> columns_;  ///< the same
  std::vector<double> sigmas_;
  Eigen::MatrixXd covariance_;
  Eigen::MatrixXd discrepancy_;  ///< s^2 K; empty without one
  Eigen::VectorXd e_;
};

/// An explanation with the amplitudes of a law at one place; null for the likeliest without a law.
[[nodiscard]] LawModel model_with(const Analysis& analysis,
                                  const LawEvidence& evidence,
                                  const WeighedLaw* law);

}  // namespace chaintrue::grid::diagnosis
