// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_axis.hpp"

#include <algorithm>
#include <cmath>

#include "interp/linear_algebra.hpp"
#include "interp/require.hpp"

namespace chaintrue::interp {
namespace {

void check_nodes(const std::vector<double>& nodes) {
  require(nodes.size() >= 2, "a spline axis needs at least 2 nodes, has {}", nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    require(std::isfinite(nodes[i]), "node {} of a spline axis is {}", i, nodes[i]);
    if (i == 0) continue;
    require(nodes[i] > nodes[i - 1],
            "nodes of a spline axis must increase: node {} is {}, node {} is {}", i - 1,
            nodes[i - 1], i, nodes[i]);
  }
}

// With too few nodes the not-a-knot condition does not determine the spline; it reduces to a vanishing
// third derivative, and for two such ends of one cell, whose conditions are the same, to a natural end.
AxisEnds effective(AxisEnds ends, Index nodes) {
  using enum EndCondition;
  const bool both = ends.low == not_a_knot && ends.high == not_a_knot;
  for (EndCondition* end : {&ends.low, &ends.high}) {
    if (*end == not_a_knot && (nodes == 2 || (nodes == 3 && both))) *end = parabolic;
  }
  if (nodes == 2 && ends.low == parabolic && ends.high == parabolic) ends.low = natural;
  return ends;
}

// The condition at each kind of end as weights on the slopes at the end, in the middle and at the far
// side of the end cell, between which the slope of a cubic is a parabola.
constexpr double kSlopeWeights[][3] = {{0, 0, 0}, {3, -4, 1}, {1, -2, 1}, {1, 0, 0}};

}  // namespace

SplineAxis::SplineAxis(std::vector<double> nodes, const AxisEnds& ends, int degree)
    : nodes_(std::move(nodes)), degree_(degree) {
  check_nodes(nodes_);
  const Index n = std::ssize(nodes_);
  if (n <= degree) degree_ = 3;
  const auto [low, high] = effective(ends, n);
  using enum EndCondition;
  const int left_out = (degree_ - 1) / 2;
  const auto at_end = static_cast<std::size_t>(degree_ + 1);
  knots_.assign(at_end, nodes_.front());
  knots_.insert(knots_.end(), nodes_.begin() + 1 + (low == not_a_knot ? left_out : 0),
                nodes_.end() - 1 - (high == not_a_knot ? left_out : 0));
  knots_.insert(knots_.end(), at_end, nodes_.back());
  const Index functions = std::ssize(knots_) - degree_ - 1;
  MatrixXd equations = MatrixXd::Zero(functions, functions);
  MatrixXd right = MatrixXd::Zero(functions, n + 2);
  right.topLeftCorner(n, n).setIdentity();
  Index row = 0;
  for (const double node : nodes_) {
    const SplineSupport s = support(node);
    equations.row(row++).segment(s.first, s.count) = s.value.head(s.count);
  }
  const auto add_end = [&](EndCondition end, double at, double inward, Index given) {
    if (end == not_a_knot) return;
    for (int k = 0; k < 3; ++k) {
      const SplineSupport s = support(at + 0.5 * k * inward);
      equations.row(row).segment(s.first, s.count) +=
          kSlopeWeights[static_cast<int>(end)][k] * s.slope.head(s.count);
    }
    if (end == clamped) right(row, given) = 1.0;
    ++row;
  };
  add_end(low, nodes_[0], nodes_[1] - nodes_[0], n);
  add_end(high, nodes_.back(), nodes_.end()[-2] - nodes_.back(), n + 1);
  require(row == functions, "a spline of degree {} without not-a-knot ends", degree_);
  solution_ = linear::inverse(equations) * right;
}

// Values by the recurrence of Cox and de Boor (de Boor, chapter X, BSPLVB); the slopes come from
// the values one degree lower.
SplineSupport SplineAxis::support(double x) const {
  const auto begin = knots_.begin() + degree_ + 1;
  const auto end = knots_.end() - degree_ - 1;
  const auto span = (std::upper_bound(begin, end, x) - knots_.begin()) - 1;
  const double* const knot = knots_.data() + span;
  SplineSupport result{span - degree_, degree_ + 1, {}, {}};
  auto& b = result.value;
  auto& slope = result.slope;
  b[0] = 1.0;
  for (int d = 1; d <= degree_; ++d) {
    double carried = 0.0;
    slope[0] = 0.0;
    for (int r = 0; r < d; ++r) {
      const double right = knot[r + 1];
      const double left = knot[r + 1 - d];
      const double part = b[r] / (right - left);
      slope[r] -= d * part;
      slope[r + 1] = d * part;
      b[r] = carried + (right - x) * part;
      carried = (x - left) * part;
    }
    b[d] = carried;
  }
  return result;
}

Eigen::MatrixX2d SplineAxis::cardinal_weights(double x) const {
  const SplineSupport s = support(x);
  Eigen::MatrixX2d here(s.count, 2);
  here << s.value.head(s.count), s.slope.head(s.count);
  return solution_.block(s.first, 0, s.count, std::ssize(nodes_)).transpose() * here;
}

}  // namespace chaintrue::interp
