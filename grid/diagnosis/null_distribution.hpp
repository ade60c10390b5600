// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The Monte Carlo distribution of the largest single score over the whole catalogue when no effect
/// acts. Scores of similar effects are far from independent, so no correction for their number is
/// valid; draws are valid for any catalogue and points. Source: V. Rofatto et al., Remote Sensing
/// 12 (2020) 860, on the largest statistic of many alternatives.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Per regressor: log of prior times Bayes factor against nothing, Student form, in one inner
/// product; a regressor of the wrong sign has no score.
class SingleScore {
 public:
  SingleScore(const RegressorSystem& system,
              const MarginalisedSystem& marginalised,
              double noise_dof);
  /// The largest of all; `e` like MarginalisedSystem::e.
  [[nodiscard]] double largest(const Eigen::VectorXd& e) const;
  /// The largest over the columns of normal equations with this many rows.
  [[nodiscard]] double largest(const NormalEquations& equations, Eigen::Index rows) const;
  /// For each column of `e`.
  [[nodiscard]] Eigen::VectorXd largest(const Eigen::MatrixXd& e) const;

 private:
  /// For a regressor with this square and inner product with the residual, in this many rows.
  [[nodiscard]] double score(Eigen::Index k, double square, double c, double ee, double n) const;
  /// A bound of it without a logarithm.
  [[nodiscard]] double most(Eigen::Index k, double square, double c, double ee, double n) const;
  /// The reduction of the residual's square by the regressor's best size, relative to noise.
  [[nodiscard]] double share_taken(std::size_t at, double square, double c, double ee) const;
  const MarginalisedSystem& marginalised_;
  double dof_;
  Eigen::VectorXd square_;
  Eigen::VectorXd constant_;
  std::vector<int> sign_;  ///< +1: coefficient >= 0 only, -1: <= 0, 0: either
  std::vector<bool> fixed_;
};

struct NullDistribution {
  std::vector<double> largest;  ///< ascending
  /// Share of draws at least as large: never 0, the data count as one draw.
  [[nodiscard]] double p_value(double score) const;
};
[[nodiscard]] NullDistribution draw_null(const SingleScore& score,
                                         Eigen::Index rows,
                                         int draws,
                                         std::uint64_t seed);
/// For residuals as long as those of `marginalised`: noise of unknown size, projected on the
/// settings in the same way.
[[nodiscard]] NullDistribution draw_null_of_length(const SingleScore& score,
                                                   const MarginalisedSystem& marginalised,
                                                   int draws,
                                                   std::uint64_t seed);

}  // namespace chaintrue::grid::diagnosis
