// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_axis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "interp/linear_algebra.hpp"

namespace chaintrue::interp {
namespace {

void check_nodes(const std::vector<double>& nodes) {
  if (nodes.size() < 2) {
    throw std::invalid_argument(
        fmt::format("a spline axis needs at least 2 nodes, has {}", nodes.size()));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (!std::isfinite(nodes[i])) {
      throw std::invalid_argument(fmt::format("node {} of a spline axis is {}", i, nodes[i]));
    }
    if (i > 0 && !(nodes[i] > nodes[i - 1])) {
      throw std::invalid_argument(
          fmt::format("nodes of a spline axis must increase: node {} is {}, node {} is {}", i - 1,
                      nodes[i - 1], i, nodes[i]));
    }
  }
}

// With too few nodes the not-a-knot condition does not determine the spline; it reduces to a vanishing
// third derivative, and for two such ends of one cell, whose conditions are the same, to a natural end.
AxisEnds effective(const AxisEnds& ends, std::size_t nodes) {
  const bool both = ends.low == EndCondition::not_a_knot && ends.high == EndCondition::not_a_knot;
  AxisEnds result = ends;
  for (EndCondition* end : {&result.low, &result.high}) {
    if (*end == EndCondition::not_a_knot && (nodes == 2 || (nodes == 3 && both)))
      *end = EndCondition::parabolic;
  }
  if (nodes == 2 && result.low == result.high && result.low == EndCondition::parabolic)
    result.low = EndCondition::natural;
  return result;
}

// The condition as weights on the slopes at the end, in the middle and at the far side of the end
// cell, between which the slope of a cubic is a parabola.
Vector3d slope_condition(EndCondition end) {
  if (end == EndCondition::natural) return {3.0, -4.0, 1.0};
  if (end == EndCondition::parabolic) return {1.0, -2.0, 1.0};
  return {1.0, 0.0, 0.0};
}

}  // namespace

SplineAxis::SplineAxis(std::vector<double> nodes, const AxisEnds& ends, int degree)
    : nodes_(std::move(nodes)), degree_(degree) {
  check_nodes(nodes_);
  const auto n = static_cast<Index>(nodes_.size());
  if (n <= degree) degree_ = 3;
  const auto [low, high] = effective(ends, nodes_.size());
  const auto left_out = [&](EndCondition end) {
    return end == EndCondition::not_a_knot ? (degree_ - 1) / 2 : 0;
  };
  const auto at_end = static_cast<std::size_t>(degree_ + 1);
  knots_.assign(at_end, nodes_.front());
  knots_.insert(knots_.end(), nodes_.begin() + 1 + left_out(low),
                nodes_.end() - 1 - left_out(high));
  knots_.insert(knots_.end(), at_end, nodes_.back());
  const auto functions = static_cast<Index>(knots_.size() - at_end);
  MatrixXd equations = MatrixXd::Zero(functions, functions);
  MatrixXd right = MatrixXd::Zero(functions, n + 2);
  right.topLeftCorner(n, n).setIdentity();
  Index row = 0;
  for (const double node : nodes_) {
    const SplineSupport s = support(node);
    equations.row(row++).segment(s.first, s.count) = s.value.head(s.count);
  }
  const auto add_end = [&](EndCondition end, double at, double inward, Index given) {
    if (end == EndCondition::not_a_knot) return;
    const Vector3d weights = slope_condition(end);
    for (Index k = 0; k < 3; ++k) {
      const SplineSupport s = support(at + 0.5 * static_cast<double>(k) * inward);
      equations.row(row).segment(s.first, s.count) += weights[k] * s.slope.head(s.count);
    }
    if (end == EndCondition::clamped) right(row, given) = 1.0;
    ++row;
  };
  add_end(low, nodes_[0], nodes_[1] - nodes_[0], n);
  add_end(high, nodes_.back(), nodes_.end()[-2] - nodes_.back(), n + 1);
  if (row != functions) {
    throw std::invalid_argument(
        fmt::format("a spline of degree {} without not-a-knot ends", degree_));
  }
  solution_ = linear::inverse(equations) * right;
}

// Values by the recurrence of Cox and de Boor (de Boor, chapter X, BSPLVB); the slopes come from
// the values one degree lower.
SplineSupport SplineAxis::support(double x) const {
  const auto begin = knots_.begin() + degree_ + 1;
  const auto end = knots_.end() - degree_ - 1;
  const auto span = (std::upper_bound(begin, end, x) - knots_.begin()) - 1;
  SplineSupport result{span - degree_, degree_ + 1, {}, {}};
  auto& b = result.value;
  auto& slope = result.slope;
  b[0] = 1.0;
  for (Index d = 1; d <= degree_; ++d) {
    double carried = 0.0;
    slope[0] = 0.0;
    for (Index r = 0; r < d; ++r) {
      const double right = knots_[static_cast<std::size_t>(span + r + 1)];
      const double left = knots_[static_cast<std::size_t>(span + 1 + r - d)];
      const double part = b[r] / (right - left);
      slope[r] -= static_cast<double>(d) * part;
      slope[r + 1] = static_cast<double>(d) * part;
      b[r] = carried + (right - x) * part;
      carried = (x - left) * part;
    }
    b[d] = carried;
  }
  return result;
}

MatrixXd SplineAxis::coefficients(const Eigen::Ref<const MatrixXd>& conditions) const {
  return solution_ * conditions;
}

VectorXd SplineAxis::cardinal_weights(double x) const {
  const SplineSupport s = support(x);
  return solution_.block(s.first, 0, s.count, std::ssize(nodes_)).transpose() *
         s.value.head(s.count);
}

VectorXd SplineAxis::slope_weights(double x) const {
  const SplineSupport s = support(x);
  return solution_.block(s.first, 0, s.count, std::ssize(nodes_)).transpose() *
         s.slope.head(s.count);
}

}  // namespace chaintrue::interp
