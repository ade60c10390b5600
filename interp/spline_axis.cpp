// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_axis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {
namespace {

// With too few nodes the not-a-knot condition gives no separate equation; it reduces to a vanishing
// third derivative.
EndCondition effective_end(EndCondition end, const AxisEnds& ends, std::size_t nodes) {
  const bool both = ends.low == EndCondition::not_a_knot && ends.high == EndCondition::not_a_knot;
  if (end == EndCondition::not_a_knot && (nodes == 2 || (nodes == 3 && both))) {
    return EndCondition::parabolic;
  }
  return end;
}

// One end's equation: diagonal * d_end + neighbour * d_next = rhs(q).
struct EndRow {
  double diagonal;
  double neighbour;
};

EndRow end_row(EndCondition end, double outer_step, double inner_step) {
  switch (end) {
    case EndCondition::not_a_knot:
      return {inner_step, outer_step + inner_step};
    case EndCondition::natural:
      return {2.0, 1.0};
    case EndCondition::parabolic:
      return {1.0, 1.0};
    case EndCondition::clamped:
      return {1.0, 0.0};
  }
  throw std::logic_error("unknown end condition");
}

// A cell's length and the difference quotient over it.
struct CellSlope {
  double step;
  double quotient;
};

double end_rhs(EndCondition end, const CellSlope& outer, const CellSlope& inner, double given) {
  switch (end) {
    case EndCondition::not_a_knot: {
      const double both = outer.step + inner.step;
      return ((outer.step + 2.0 * both) * inner.step * outer.quotient +
              outer.step * outer.step * inner.quotient) /
             both;
    }
    case EndCondition::natural:
      return 3.0 * outer.quotient;
    case EndCondition::parabolic:
      return 2.0 * outer.quotient;
    case EndCondition::clamped:
      return given;
  }
  throw std::logic_error("unknown end condition");
}

}  // namespace

SplineAxis::SplineAxis(std::vector<double> nodes, AxisEnds ends)
    : nodes_(std::move(nodes)), ends_(ends) {
  if (nodes_.size() < 2) {
    throw std::invalid_argument(
        fmt::format("a spline axis needs at least 2 nodes, has {}", nodes_.size()));
  }
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!std::isfinite(nodes_[i])) {
      throw std::invalid_argument(fmt::format("node {} of a spline axis is {}", i, nodes_[i]));
    }
    if (i > 0 && !(nodes_[i] > nodes_[i - 1])) {
      throw std::invalid_argument(
          fmt::format("nodes of a spline axis must increase: node {} is {}, node {} is {}",
                      i - 1,
                      nodes_[i - 1],
                      i,
                      nodes_[i]));
    }
  }
  factor();
}

void SplineAxis::factor() {
  const std::size_t n = nodes_.size();
  step_.resize(n - 1);
  inverse_step_.resize(n - 1);
  for (std::size_t i = 0; i + 1 < n; ++i) {
    step_[i] = nodes_[i + 1] - nodes_[i];
    inverse_step_[i] = 1.0 / step_[i];
  }
  const EndCondition low = effective_end(ends_.low, ends_, n);
  const EndCondition high = effective_end(ends_.high, ends_, n);
  // Two nodes, no slope given: the two end equations are the same, and the straight line is the
  // solution.
  straight_line_ = n == 2 && low == EndCondition::parabolic && high == EndCondition::parabolic;
  if (straight_line_) {
    return;
  }
  lower_.assign(n, 0.0);
  upper_.assign(n, 0.0);
  inverse_pivot_.assign(n, 0.0);

  const EndRow first = end_row(low, step_[0], n > 2 ? step_[1] : step_[0]);
  inverse_pivot_[0] = 1.0 / first.diagonal;
  upper_[0] = first.neighbour * inverse_pivot_[0];
  for (std::size_t i = 1; i + 1 < n; ++i) {
    lower_[i] = step_[i];
    const double pivot = 2.0 * (step_[i - 1] + step_[i]) - lower_[i] * upper_[i - 1];
    inverse_pivot_[i] = 1.0 / pivot;
    upper_[i] = step_[i - 1] * inverse_pivot_[i];
  }
  const EndRow last = end_row(high, step_[n - 2], n > 2 ? step_[n - 3] : step_[n - 2]);
  lower_[n - 1] = last.neighbour;
  inverse_pivot_[n - 1] = 1.0 / (last.diagonal - last.neighbour * upper_[n - 2]);
}

std::size_t SplineAxis::cell(double x) const {
  const auto inner_end = nodes_.end() - 1;
  const auto above = std::upper_bound(nodes_.begin() + 1, inner_end, x);
  return static_cast<std::size_t>(above - nodes_.begin()) - 1;
}

void SplineAxis::slopes(const double* values,
                        double* slopes,
                        const LineLayout& layout,
                        const double* low_slopes,
                        const double* high_slopes) const {
  // Eight lines at a time: their recurrences are independent, and every fetched cache line is used
  // whichever way the lines run in memory.
  constexpr std::size_t kAbreast = 8;
  for (std::size_t first = 0; first < layout.lines; first += kAbreast) {
    const auto offset = static_cast<std::ptrdiff_t>(first) * layout.line_step;
    LineLayout part = layout;
    part.lines = std::min(kAbreast, layout.lines - first);
    solve_abreast(values + offset,
                  slopes + offset,
                  part,
                  low_slopes != nullptr ? low_slopes + first : nullptr,
                  high_slopes != nullptr ? high_slopes + first : nullptr);
  }
}

void SplineAxis::solve_abreast(const double* f,
                               double* d,
                               const LineLayout& layout,
                               const double* low_slopes,
                               const double* high_slopes) const {
  const std::size_t n = nodes_.size();
  const auto last = static_cast<std::ptrdiff_t>(n) - 1;
  const std::ptrdiff_t step = layout.step;
  const auto lines = static_cast<std::ptrdiff_t>(layout.lines);
  const auto quotient = [&](std::ptrdiff_t i, std::ptrdiff_t line) {
    const double* at = f + i * step + line * layout.line_step;
    return (at[step] - at[0]) * inverse_step_[static_cast<std::size_t>(i)];
  };
  const auto slope = [&](std::ptrdiff_t i, std::ptrdiff_t line) -> double& {
    return d[i * step + line * layout.line_step];
  };
  if (straight_line_) {
    for (std::ptrdiff_t line = 0; line < lines; ++line) {
      slope(0, line) = quotient(0, line);
      slope(1, line) = quotient(0, line);
    }
    return;
  }
  const EndCondition low = effective_end(ends_.low, ends_, n);
  const EndCondition high = effective_end(ends_.high, ends_, n);
  const std::ptrdiff_t second = n > 2 ? 1 : 0;
  for (std::ptrdiff_t line = 0; line < lines; ++line) {
    slope(0, line) = inverse_pivot_[0] *
                     end_rhs(low,
                             {step_[0], quotient(0, line)},
                             {step_[static_cast<std::size_t>(second)], quotient(second, line)},
                             low_slopes != nullptr ? low_slopes[line] : 0.0);
  }
  for (std::ptrdiff_t i = 1; i < last; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double before = 3.0 * step_[k] * inverse_pivot_[k];
    const double after = 3.0 * step_[k - 1] * inverse_pivot_[k];
    const double carry = lower_[k] * inverse_pivot_[k];
    for (std::ptrdiff_t line = 0; line < lines; ++line) {
      slope(i, line) = before * quotient(i - 1, line) + after * quotient(i, line) -
                       carry * slope(i - 1, line);  // (1)
    }
  }
  const std::ptrdiff_t inner = last - 1 - second;
  for (std::ptrdiff_t line = 0; line < lines; ++line) {
    const double rhs = end_rhs(high,
                               {step_[n - 2], quotient(last - 1, line)},
                               {step_[static_cast<std::size_t>(inner)], quotient(inner, line)},
                               high_slopes != nullptr ? high_slopes[line] : 0.0);
    slope(last, line) = (rhs - lower_[n - 1] * slope(last - 1, line)) * inverse_pivot_[n - 1];
  }
  for (std::ptrdiff_t i = last - 1; i >= 0; --i) {
    const double upper = upper_[static_cast<std::size_t>(i)];
    for (std::ptrdiff_t line = 0; line < lines; ++line) {
      slope(i, line) -= upper * slope(i + 1, line);
    }
  }
}

HermiteWeights SplineAxis::weights(std::size_t cell, double x) const {
  const double h = step_[cell];
  const double t = (x - nodes_[cell]) * inverse_step_[cell];
  const double s = 1.0 - t;
  return {s * s * (1.0 + 2.0 * t), t * t * (3.0 - 2.0 * t), h * t * s * s, -h * t * t * s};
}

HermiteWeights SplineAxis::derivative_weights(std::size_t cell, double x) const {
  const double t = (x - nodes_[cell]) * inverse_step_[cell];
  const double s = 1.0 - t;
  const double slope = 6.0 * t * s * inverse_step_[cell];
  return {-slope, slope, s * (s - 2.0 * t), t * (t - 2.0 * s)};
}

Eigen::VectorXd SplineAxis::cardinal_weights(double x) const {
  const auto n = static_cast<Eigen::Index>(size());
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(n, n);
  Eigen::MatrixXd slope(n, n);
  slopes(unit.data(), slope.data(), {size(), 1, n});
  const std::size_t at = cell(x);
  const auto i = static_cast<Eigen::Index>(at);
  const HermiteWeights w = weights(at, x);
  Eigen::VectorXd result =
      w.slope_low * slope.row(i).transpose() + w.slope_high * slope.row(i + 1).transpose();
  result(i) += w.value_low;
  result(i + 1) += w.value_high;
  return result;
}

}  // namespace chaintrue::interp
