// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Settings, sizes of causes and, where there is one, the unknown pattern, for one model of the
/// contest; and what is then left at every point, those that were held out included.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/diagnosis/contest.hpp"

namespace chaintrue::grid::diagnosis {

struct Estimate {
  std::vector<int> directions;
  Eigen::VectorXd setting_change;  ///< from the state of the rows
  Eigen::MatrixXd setting_covariance;
  Eigen::VectorXd coefficient;  ///< of each direction
  /// 0 where the size is a whole number; at a bound what noise alone makes of it.
  Eigen::VectorXd coefficient_sigma;
  double noise_square = 1.0;            ///< s^2
  Eigen::VectorXd left;                 ///< whitened, all rows, the pattern not taken out
  Eigen::VectorXd left_beside_pattern;  ///< the same with the pattern taken out
  Pattern pattern;
  Eigen::VectorXd pattern_weights;  ///< per kept row; empty without a pattern
  /// Covariance of setting_change and of the free coefficients, in that order.
  Eigen::MatrixXd covariance;
  std::vector<std::size_t> free;  ///< positions in `directions`
};

/// `directions` and `pattern` as the model has them. A coefficient that would leave its bounds
/// stays at the bound.
[[nodiscard]] Estimate estimate(const Session& session,
                                const Rows& rows,
                                const Space& space,
                                const std::vector<int>& directions,
                                int pattern);

/// What the unknown pattern adds to either chain at a place [mm]; zero where the estimate has none.
[[nodiscard]] Eigen::Vector2d pattern_at(const Session& session,
                                         const Rows& rows,
                                         const Space& space,
                                         const Estimate& estimate,
                                         const PatternPlace& place);

/// Residuals at the points in the chains [mm].
[[nodiscard]] std::vector<Eigen::Vector2d> chain_residuals(const Rows& rows,
                                                           const Eigen::VectorXd& whitened);
/// A chain residual as a shift of the tool [mm]: where it truly was less where the model has it.
[[nodiscard]] Eigen::Vector2d tool_shift(const PointState& point, const Eigen::Vector2d& chain_mm);

}  // namespace chaintrue::grid::diagnosis
