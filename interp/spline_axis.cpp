// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_axis.hpp"

#include <algorithm>
#include <array>
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
          fmt::format("nodes of a spline axis must increase: node {} is {}, node {} is {}",
                      i - 1,
                      nodes[i - 1],
                      i,
                      nodes[i]));
    }
  }
}

// With too few nodes the not-a-knot condition gives no separate equation; it reduces to a vanishing
// third derivative.
EndCondition effective_end(EndCondition end, const AxisEnds& ends, std::size_t nodes) {
  const bool both = ends.low == EndCondition::not_a_knot && ends.high == EndCondition::not_a_knot;
  if (end == EndCondition::not_a_knot && (nodes == 2 || (nodes == 3 && both))) {
    return EndCondition::parabolic;
  }
  return end;
}

// One end's equation: own slope, the next one; q of the end cell, and of the one beside it.
std::array<double, 4> end_equation(EndCondition end, double outer_step, double inner_step) {
  const double both = outer_step + inner_step;
  switch (end) {
    case EndCondition::not_a_knot:
      return {inner_step,
              both,
              (outer_step + 2.0 * both) * inner_step / both,
              outer_step * outer_step / both};
    case EndCondition::natural:
      return {2.0, 1.0, 3.0, 0.0};
    case EndCondition::parabolic:
      return {1.0, 1.0, 2.0, 0.0};
    case EndCondition::clamped:
      return {1.0, 0.0, 0.0, 0.0};
  }
  throw std::logic_error("unknown end condition");
}

// The slopes per value, and per slope given at the low and at the high end.
Eigen::MatrixXd solve_slopes(const std::vector<double>& nodes,
                             EndCondition low,
                             EndCondition high) {
  const auto n = static_cast<Eigen::Index>(nodes.size());
  const Eigen::Map<const Eigen::VectorXd> x(nodes.data(), n);
  const Eigen::VectorXd h = x.tail(n - 1) - x.head(n - 1);
  Eigen::MatrixXd left = Eigen::MatrixXd::Zero(n, n);
  Eigen::MatrixXd right = Eigen::MatrixXd::Zero(n, n + 2);
  const auto add_quotient = [&](Eigen::Index row, Eigen::Index cell, double factor) {
    right(row, cell) -= factor / h(cell);
    right(row, cell + 1) += factor / h(cell);
  };
  for (Eigen::Index i = 1; i + 1 < n; ++i) {  // (1)
    left.row(i).segment<3>(i - 1) << h(i), 2.0 * (h(i - 1) + h(i)), h(i - 1);
    add_quotient(i, i - 1, 3.0 * h(i));
    add_quotient(i, i, 3.0 * h(i - 1));
  }
  const auto set_end = [&](EndCondition end, Eigen::Index row, Eigen::Index inward) {
    const Eigen::Index outer = std::min(row, n - 2);
    const Eigen::Index inner = std::clamp<Eigen::Index>(outer + inward, 0, n - 2);
    const auto [own, next, of_outer, of_inner] = end_equation(end, h(outer), h(inner));
    left(row, row) = own;
    left(row, row + inward) = next;
    add_quotient(row, outer, of_outer);
    add_quotient(row, inner, of_inner);
    if (end == EndCondition::clamped) right(row, inward > 0 ? n : n + 1) = 1.0;
  };
  set_end(low, 0, 1);
  set_end(high, n - 1, -1);
  return linear::inverse(left) * right;
}

}  // namespace

SplineAxis::SplineAxis(std::vector<double> nodes, const AxisEnds& ends)
    : nodes_(std::move(nodes)) {
  check_nodes(nodes_);
  EndCondition low = effective_end(ends.low, ends, nodes_.size());
  const EndCondition high = effective_end(ends.high, ends, nodes_.size());
  // Both equations are the same; a natural end gives the straight line as well.
  const bool is_line = nodes_.size() == 2 && low == high && high == EndCondition::parabolic;
  if (is_line) low = EndCondition::natural;
  solution_ = solve_slopes(nodes_, low, high);
}

std::size_t SplineAxis::cell(double x) const {
  const auto inner_end = nodes_.end() - 1;
  const auto above = std::upper_bound(nodes_.begin() + 1, inner_end, x);
  return static_cast<std::size_t>(above - nodes_.begin()) - 1;
}

Eigen::MatrixXd SplineAxis::slopes(const Eigen::Ref<const Eigen::MatrixXd>& values,
                                   const Eigen::VectorXd& low_slopes,
                                   const Eigen::VectorXd& high_slopes) const {
  const Eigen::Index n = values.rows();
  Eigen::MatrixXd result = solution_.leftCols(n) * values;
  if (low_slopes.size() > 0) result += solution_.col(n) * low_slopes.transpose();
  if (high_slopes.size() > 0) result += solution_.col(n + 1) * high_slopes.transpose();
  return result;
}

HermiteWeights SplineAxis::weights(std::size_t cell, double x) const {
  const double h = nodes_[cell + 1] - nodes_[cell];
  const double t = (x - nodes_[cell]) / h;
  const double s = 1.0 - t;
  return {s * s * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t), h * t * s * s, -h * t * t * s};
}

HermiteWeights SplineAxis::derivative_weights(std::size_t cell, double x) const {
  const double h = nodes_[cell + 1] - nodes_[cell];
  const double t = (x - nodes_[cell]) / h;
  const double s = 1.0 - t;
  const double slope = 6.0 * t * s / h;
  return {-slope, slope, s * (s - 2.0 * t), t * (t - 2.0 * s)};
}

Eigen::VectorXd SplineAxis::cardinal_weights(double x) const {
  const std::size_t at = cell(x);
  const auto i = static_cast<Eigen::Index>(at);
  const HermiteWeights w = weights(at, x);
  const auto slope = solution_.leftCols(solution_.rows());
  Eigen::VectorXd result =
      w.slope_low * slope.row(i).transpose() + w.slope_high * slope.row(i + 1).transpose();
  result(i) += w.value_low;
  result(i + 1) += w.value_high;
  return result;
}

}  // namespace chaintrue::interp
