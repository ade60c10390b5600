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

// One end's equation, with q the difference quotients of the end cell and of the next one:
// diagonal d_end + neighbour d_next = (outer q_outer + inner q_inner) / divisor, or the slope given.
struct EndRow {
  double diagonal;
  double neighbour;
  double outer = 0.0;
  double inner = 0.0;
  double divisor = 1.0;
  bool is_given = false;
};

EndRow end_row(EndCondition end, double outer_step, double inner_step) {
  switch (end) {
    case EndCondition::not_a_knot: {
      const double both = outer_step + inner_step;
      return {
          inner_step, both, (outer_step + 2.0 * both) * inner_step, outer_step * outer_step, both};
    }
    case EndCondition::natural:
      return {2.0, 1.0, 3.0};
    case EndCondition::parabolic:
      return {1.0, 1.0, 2.0};
    case EndCondition::clamped:
      return {.diagonal = 1.0, .neighbour = 0.0, .is_given = true};
  }
  throw std::logic_error("unknown end condition");
}

struct EndRows {
  EndRow low;
  EndRow high;
};

EndRows end_rows(const AxisEnds& ends, const std::vector<double>& steps) {
  const std::size_t last = steps.size() - 1;
  const std::size_t next = std::min<std::size_t>(last, 1);
  return {end_row(effective_end(ends.low, ends, last + 2), steps[0], steps[next]),
          end_row(effective_end(ends.high, ends, last + 2), steps[last], steps[last - next])};
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
  const auto is_parabolic = [&](EndCondition end) {
    return effective_end(end, ends_, n) == EndCondition::parabolic;
  };
  // Two nodes, no slope given: the two end equations are the same, and the straight line is the
  // solution.
  straight_line_ = n == 2 && is_parabolic(ends_.low) && is_parabolic(ends_.high);
  if (straight_line_) {
    return;
  }
  const auto [first, last] = end_rows(ends_, step_);
  lower_.assign(n, 0.0);
  upper_.assign(n, 0.0);
  inverse_pivot_.assign(n, 0.0);

  inverse_pivot_[0] = 1.0 / first.diagonal;
  upper_[0] = first.neighbour * inverse_pivot_[0];
  for (std::size_t i = 1; i + 1 < n; ++i) {
    lower_[i] = step_[i];
    const double pivot = 2.0 * (step_[i - 1] + step_[i]) - lower_[i] * upper_[i - 1];
    inverse_pivot_[i] = 1.0 / pivot;
    upper_[i] = step_[i - 1] * inverse_pivot_[i];
  }
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
  const auto [low, high] = end_rows(ends_, step_);
  const std::ptrdiff_t second = n > 2 ? 1 : 0;
  const auto right_side = [&](const EndRow& row,
                              std::ptrdiff_t outer,
                              std::ptrdiff_t inner,
                              const double* given,
                              std::ptrdiff_t line) {
    if (row.is_given) return given != nullptr ? given[line] : 0.0;
    return (row.outer * quotient(outer, line) + row.inner * quotient(inner, line)) / row.divisor;
  };
  for (std::ptrdiff_t line = 0; line < lines; ++line)
    slope(0, line) = inverse_pivot_[0] * right_side(low, 0, second, low_slopes, line);
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
  for (std::ptrdiff_t line = 0; line < lines; ++line) {
    const double rhs = right_side(high, last - 1, last - 1 - second, high_slopes, line);
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
