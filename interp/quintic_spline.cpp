// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/quintic_spline.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>
#include <Eigen/LU>

#include "interp/spline_axis.hpp"

namespace chaintrue::interp {
namespace {

using Axis = QuinticSpline::Axis;

// The basis functions that do not vanish at a point, and their slopes.
struct Support {
  Eigen::Index first;
  std::array<double, 6> value;
  std::array<double, 6> slope;
};

Axis make_axis(const std::vector<double>& nodes) {
  const SplineAxis checked(nodes);  // throws if the nodes are no axis
  const auto n = static_cast<int>(nodes.size());
  Axis axis;
  axis.degree = n >= 6 ? 5 : std::min(n - 1, 3);
  axis.knots.assign(static_cast<std::size_t>(axis.degree) + 1, nodes.front());
  // Drop as many knots at each end as leave n functions; a parabola has no interior knot.
  const int drop = (axis.degree + 1) / 2;
  for (int i = drop; axis.degree != 2 && i < n - drop; ++i) {
    axis.knots.push_back(nodes[static_cast<std::size_t>(i)]);
  }
  axis.knots.insert(axis.knots.end(), static_cast<std::size_t>(axis.degree) + 1, nodes.back());
  axis.functions = static_cast<Eigen::Index>(axis.knots.size()) - axis.degree - 1;
  return axis;
}

// Values by the recurrence of Cox and de Boor (de Boor, chapter X, BSPLVB); the slopes come from
// the values one degree lower. Valid as polynomials beyond the span as well.
Support support(const Axis& axis, double x) {
  const auto degree = static_cast<std::size_t>(axis.degree);
  const auto begin = axis.knots.begin() + axis.degree + 1;
  const auto end = axis.knots.end() - axis.degree - 1;
  const auto above = std::upper_bound(begin, end, x);
  const auto span = static_cast<std::size_t>(above - axis.knots.begin()) - 1;
  Support result{static_cast<Eigen::Index>(span - degree), {}, {}};
  std::array<double, 6> lower{};
  auto& b = result.value;
  b[0] = 1.0;
  for (std::size_t d = 1; d <= degree; ++d) {
    if (d == degree) {
      lower = b;
    }
    double carried = 0.0;
    for (std::size_t r = 0; r < d; ++r) {
      const double right = axis.knots[span + r + 1];
      const double left = axis.knots[span + 1 + r - d];
      const double part = b[r] / (right - left);
      b[r] = carried + (right - x) * part;
      carried = (x - left) * part;
    }
    b[d] = carried;
  }
  double before = 0.0;
  for (std::size_t r = 0; r <= degree; ++r) {
    double after = 0.0;
    if (r < degree) {
      after = lower[r] / (axis.knots[span + r + 1] - axis.knots[span + 1 + r - degree]);
    }
    result.slope[r] = static_cast<double>(degree) * (before - after);
    before = after;
  }
  return result;
}

Eigen::PartialPivLU<Eigen::MatrixXd> collocation(const Axis& axis,
                                                 const std::vector<double>& nodes) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(axis.functions, axis.functions);
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const Support s = support(axis, nodes[i]);
    for (int r = 0; r <= axis.degree; ++r) {
      matrix(static_cast<Eigen::Index>(i), s.first + r) = s.value[static_cast<std::size_t>(r)];
    }
  }
  return Eigen::PartialPivLU<Eigen::MatrixXd>(matrix);
}

}  // namespace

QuinticSpline::QuinticSpline(const std::vector<double>& x_nodes,
                             const std::vector<double>& y_nodes,
                             const Eigen::Ref<const Eigen::MatrixXd>& values)
    : x_(make_axis(x_nodes)), y_(make_axis(y_nodes)) {
  if (values.rows() != x_.functions || values.cols() != y_.functions) {
    throw std::invalid_argument(fmt::format("{} x {} values for {} x {} nodes",
                                            values.rows(),
                                            values.cols(),
                                            x_nodes.size(),
                                            y_nodes.size()));
  }
  if (!values.allFinite()) {
    throw std::invalid_argument("a value of the grid is not finite");
  }
  domain_ = {x_nodes.front(), x_nodes.back(), y_nodes.front(), y_nodes.back()};
  const Eigen::MatrixXd along_x = collocation(x_, x_nodes).solve(values);
  coefficients_ = collocation(y_, y_nodes).solve(along_x.transpose()).transpose();
}

ValueGradient QuinticSpline::at(double x, double y) const {
  const Support sx = support(x_, x);
  const Support sy = support(y_, y);
  ValueGradient result;
  for (int j = 0; j <= y_.degree; ++j) {
    double value = 0.0;
    double slope = 0.0;
    for (int i = 0; i <= x_.degree; ++i) {
      const double c = coefficients_(sx.first + i, sy.first + j);
      value += c * sx.value[static_cast<std::size_t>(i)];
      slope += c * sx.slope[static_cast<std::size_t>(i)];
    }
    result.value += value * sy.value[static_cast<std::size_t>(j)];
    result.dx += slope * sy.value[static_cast<std::size_t>(j)];
    result.dy += value * sy.slope[static_cast<std::size_t>(j)];
  }
  return result;
}

}  // namespace chaintrue::interp
