// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Spline interpolation along one axis, solved once and applied to any number of lines.
///
/// A spline of degree 3 or 5 is a sum of B-splines, as many as there are conditions on it: its value
/// at every node, and one condition at each end. The knots are the nodes; a not-a-knot end has no
/// condition but leaves out the (degree - 1) / 2 knots next to it (C. de Boor, A Practical Guide to
/// Splines, revised edition 2001, chapters IX, X and XIII). The coefficients are linear in the
/// conditions; measured axes have some ten nodes, so that matrix is kept.
///
/// With two nodes every end but a clamped one gives the straight line; with three nodes two
/// not-a-knot ends give the parabola, as Octave's interp1 does. A quintic needs six nodes; with fewer
/// an axis asked for one carries the cubic.

#include <cstddef>
#include <span>
#include <vector>

#include "interp/eigen.hpp"

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

/// Values and slopes at a point of the degree + 1 B-splines that do not vanish there.
struct SplineSupport {
  Index first;
  Index count;
  Eigen::Vector<double, 6> value, slope;  ///< the first `count` of them
};

/// One axis with its ends. Immutable; safe to share between threads.
///
///     SplineAxis axis({0.0, 1.0, 3.0, 4.0});
///     auto weights = axis.cardinal_weights(2.5);   // spline(2.5) = weights.col(0) . f
class SplineAxis {
 public:
  /// A quintic's ends are not-a-knot. Throws std::invalid_argument for others, and unless there are
  /// at least two finite, strictly increasing nodes.
  explicit SplineAxis(std::vector<double> nodes, const AxisEnds& ends = {}, int degree = 3);

  std::span<const double> nodes() const { return nodes_; }
  std::size_t size() const { return nodes_.size(); }

  /// Beyond the ends the polynomials of the end cells continue.
  SplineSupport support(double x) const;

  /// The coefficients of a spline are this times its conditions: the values at the nodes, then the
  /// slopes at the low and the high end, which count where these are clamped.
  const MatrixXd& solution() const { return solution_; }

  /// The spline at x and its slope there as weights on the node values, a column each (clamped ends:
  /// slope zero).
  Eigen::MatrixX2d cardinal_weights(double x) const;

 private:
  std::vector<double> nodes_;
  int degree_;
  std::vector<double> knots_;  // degree + 1 times each end
  MatrixXd solution_;
};

}  // namespace chaintrue::interp
