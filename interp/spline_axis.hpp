// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Cubic spline interpolation along one axis, solved once and applied to any number of lines.
///
/// A C2 cubic spline through (x_i, f_i) is fixed by its slopes d_i at the nodes. They solve a
/// tridiagonal system (C. de Boor, A Practical Guide to Splines, revised edition 2001, chapter IV,
/// equations (6) to (15)):
///
///     h_i d_{i-1} + 2 (h_{i-1} + h_i) d_i + h_{i-1} d_{i+1} = 3 (h_i q_{i-1} + h_{i-1} q_i) (1)
///
/// with h_i = x_{i+1} - x_i and q_i = (f_{i+1} - f_i) / h_i, and one equation for each end. The
/// slopes are linear in the values; measured axes have some ten nodes, so that matrix is kept.
///
/// With two nodes every end but a clamped one gives the straight line; with three nodes two
/// not-a-knot ends give the parabola, as Octave's interp1 does.

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace chaintrue::interp {

/// The condition at one end of an axis.
enum class EndCondition {
  not_a_knot,  ///< the first two cells carry one cubic (MATLAB, Octave, FITPACK)
  natural,     ///< second derivative zero (GSL)
  parabolic,   ///< third derivative zero in the end cell (ALGLIB)
  clamped,     ///< slope given
};

/// The two ends of one axis.
struct AxisEnds {
  EndCondition low = EndCondition::not_a_knot;
  EndCondition high = EndCondition::not_a_knot;
};

/// The four cubic Hermite basis functions of one cell, or their derivatives: the spline is
/// value_low f_i + value_high f_{i+1} + slope_low d_i + slope_high d_{i+1}.
struct HermiteWeights {
  double value_low;
  double value_high;
  double slope_low;
  double slope_high;
};

/// One axis with its ends. Immutable; safe to share between threads.
///
///     SplineAxis axis({0.0, 1.0, 3.0, 4.0}, {});
///     Eigen::Vector4d weights = axis.cardinal_weights(2.5);   // spline(2.5) = weights . f
class SplineAxis {
 public:
  /// Throws std::invalid_argument unless there are at least two finite, strictly increasing nodes.
  explicit SplineAxis(std::vector<double> nodes, const AxisEnds& ends = {});

  [[nodiscard]] std::span<const double> nodes() const { return nodes_; }
  [[nodiscard]] std::size_t size() const { return nodes_.size(); }

  /// The cell used for x: 0 .. size()-2; the end cells are also used beyond them.
  [[nodiscard]] std::size_t cell(double x) const;

  /// Slopes at the nodes of the splines through each column of `values`. The slopes at a clamped end
  /// are given, one a column (empty: zero).
  [[nodiscard]] Eigen::MatrixXd slopes(const Eigen::Ref<const Eigen::MatrixXd>& values,
                                       const Eigen::VectorXd& low_slopes = {},
                                       const Eigen::VectorXd& high_slopes = {}) const;

  /// Basis functions of `cell` at x and their derivatives; beyond the cell the cubic continues.
  [[nodiscard]] HermiteWeights weights(std::size_t cell, double x) const;
  [[nodiscard]] HermiteWeights derivative_weights(std::size_t cell, double x) const;

  /// The spline at x as weights on the node values (clamped ends: slope zero).
  [[nodiscard]] Eigen::VectorXd cardinal_weights(double x) const;

 private:
  std::vector<double> nodes_;
  /// The slopes are this times the values, followed by the slopes given at the low and the high end.
  Eigen::MatrixXd solution_;
};

}  // namespace chaintrue::interp
