// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/bspline_basis.hpp"

#include <algorithm>
#include <cmath>

#include "interp/require.hpp"

namespace chaintrue::interp {
namespace {

// Six times the four B-splines over one cell, as powers of the place in it from 0 to 1.
constexpr double kSixfold[4][4] = {{1, -3, 3, -1}, {4, 0, -6, 3}, {1, 3, 3, -3}, {0, 0, 0, 1}};

struct AxisSupport {
  Index first;
  Vector4d value, slope;
};

AxisSupport support(const BsplineAxis& axis, double position) {
  const auto cells = static_cast<double>(axis.columns - 3);
  const double u = (position - axis.low) / axis.step;
  const double inside = std::clamp(u, 0.0, cells);
  const double cell = std::min(std::floor(inside), cells - 1.0);
  const double t = inside - cell;
  const double beyond = u - inside;
  AxisSupport result{static_cast<Index>(cell), {}, {}};
  for (Index i = 0; i < 4; ++i) {
    const auto& [c0, c1, c2, c3] = kSixfold[i];
    result.slope[i] = (c1 + t * (2.0 * c2 + t * (3.0 * c3))) / 6.0;
    result.value[i] = (c0 + t * (c1 + t * (c2 + t * c3))) / 6.0 + beyond * result.slope[i];
    result.slope[i] /= axis.step;
  }
  return result;
}

// Integral over the axis of the product of two functions' derivatives of one order, for all pairs.
MatrixXd gram_of(const BsplineAxis& axis, int order) {
  Matrix4d powers = Eigen::Map<const Matrix4d>(kSixfold[0]) / 6.0;  // (power, function)
  Matrix4d derivative = Matrix4d::Zero();
  derivative.diagonal<1>() << 1.0, 2.0, 3.0;
  for (int k = 0; k < order; ++k) powers = derivative * powers;
  // The integral of t^i t^j over a cell is 1 / (i + j + 1).
  const Matrix4d integrals =
      Matrix4d::NullaryExpr([](Index i, Index j) { return 1.0 / static_cast<double>(i + j + 1); });
  const Matrix4d cell =
      std::pow(axis.step, 1 - 2 * order) * powers.transpose() * integrals * powers;
  MatrixXd gram = MatrixXd::Zero(axis.columns, axis.columns);
  for (Index i = 0; i + 3 < axis.columns; ++i) gram.block<4, 4>(i, i) += cell;
  return gram;
}

// The coefficients along one axis of 1, u and u^2, with u from -1 to 1 on it: by Marsden's identity
// (de Boor, chapter IX, (30)) those of u are its values at the knot averages; those of u^2 are its
// values there minus a third of the squared step.
Eigen::MatrixX3d axis_polynomials(Index columns) {
  const double step = 2.0 / static_cast<double>(columns - 3);
  const VectorXd u = VectorXd::LinSpaced(columns, -1.0 - step, 1.0 + step);
  Eigen::MatrixX3d polynomials(columns, 3);
  polynomials << VectorXd::Ones(columns), u, u.array().square() - step * step / 3.0;
  return polynomials;
}

}  // namespace

BsplineBasis::BsplineBasis(const Rectangle& rectangle, int nx, int ny)
    : rectangle_(rectangle),
      x_{rectangle.x_min, rectangle.width() / nx, nx + 3},
      y_{rectangle.y_min, rectangle.height() / ny, ny + 3} {
  require(nx >= 1 && ny >= 1, "a B-spline basis of {} x {} intervals", nx, ny);
  require(x_.step > 0.0 && y_.step > 0.0 && std::isfinite(x_.step + y_.step),
          "a B-spline basis over a rectangle of {} x {}", rectangle.width(), rectangle.height());
}

BasisSupport BsplineBasis::at(double x, double y) const {
  const AxisSupport sx = support(x_, x);
  const AxisSupport sy = support(y_, y);
  BasisSupport result;
  Eigen::Map<Matrix4d>(result.value.data()) = sx.value * sy.value.transpose();
  Index k = 0;
  for (Index& index : result.index) {
    index = (sy.first + k / 4) * x_.columns + sx.first + k % 4;
    ++k;
  }
  return result;
}

VectorXd BsplineBasis::row(double x, double y) const {
  const BasisSupport here = at(x, y);
  VectorXd row = VectorXd::Zero(size());
  for (std::size_t k = 0; k < 16; ++k) row[here.index[k]] = here.value[k];
  return row;
}

ValueGradient BsplineBasis::evaluate(const Eigen::Ref<const VectorXd>& coefficients, double x,
                                     double y) const {
  require(coefficients.size() == size(), "{} coefficients for a basis of {} functions",
          coefficients.size(), size());
  const AxisSupport sx = support(x_, x);
  const AxisSupport sy = support(y_, y);
  const Eigen::Map<const MatrixXd> all(coefficients.data(), x_.columns, y_.columns);
  const Matrix4d here = all.block<4, 4>(sx.first, sy.first);
  const Vector4d along_x = here * sy.value;
  return {sx.value.dot(along_x), sx.slope.dot(along_x), sx.value.dot(here * sy.slope)};
}

MatrixXd BsplineBasis::bending_penalty(int order) const {
  require(order == 2 || order == 3, "a bending penalty of order {}; known are 2 and 3", order);
  const Index m = x_.columns;
  MatrixXd penalty = MatrixXd::Zero(size(), size());
  double binomial = 1.0;
  for (int in_y = 0; in_y <= order; ++in_y) {
    const MatrixXd along_x = gram_of(x_, order - in_y);
    const MatrixXd along_y = binomial * gram_of(y_, in_y);
    for (Index i = 0; i < y_.columns; ++i) {
      for (Index j = 0; j < y_.columns; ++j)
        penalty.block(i * m, j * m, m, m) += along_y(i, j) * along_x;
    }
    binomial *= static_cast<double>(order - in_y) / (in_y + 1);
  }
  return penalty;
}

MatrixXd BsplineBasis::polynomial_coefficients(int degree) const {
  require(degree == 1 || degree == 2, "polynomials of degree {}; known are 1 and 2", degree);
  constexpr Index kPowers[][2] = {{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}};
  const auto along_x = axis_polynomials(x_.columns);
  const auto along_y = axis_polynomials(y_.columns);
  MatrixXd polynomials(size(), degree == 1 ? 3 : 6);
  for (Index k = 0; k < polynomials.cols(); ++k) {
    const auto [u, v] = kPowers[k];
    polynomials.col(k) = (along_x.col(u) * along_y.col(v).transpose()).reshaped();
  }
  return polynomials;
}

}  // namespace chaintrue::interp
