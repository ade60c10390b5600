// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/bspline_basis.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

namespace chaintrue::interp {
namespace {

using Four = std::array<double, 4>;

// The derivative of that order (0 to 3) with respect to t of the four B-splines over one cell, at t in
// [0, 1]: de Boor's recurrence on unit knots raises the degree to 3 - order, and each derivative is a
// difference of two splines one degree lower.
Four splines(double t, int order) {
  Four b = {1.0};
  for (std::size_t degree = 1; degree <= 3; ++degree) {
    const auto d = static_cast<double>(degree);
    const bool raises = static_cast<int>(degree) + order <= 3;
    for (std::size_t r = degree + 1; r-- > 0;) {
      const double left = r > 0 ? b[r - 1] : 0.0;
      const auto at = static_cast<double>(r);
      b[r] = raises ? ((t + d - at) * left + (at + 1.0 - t) * b[r]) / d : left - b[r];
    }
  }
  return b;
}

struct AxisSupport {
  Index first;
  Four value;
  Four slope;
};

AxisSupport axis_support(double position, double low, double step, Index columns) {
  const auto cells = static_cast<double>(columns - 3);
  const double u = (position - low) / step;
  const double inside = std::clamp(u, 0.0, cells);
  const double cell = std::min(std::floor(inside), cells - 1.0);
  AxisSupport result{static_cast<Index>(cell), splines(inside - cell, 0),
                     splines(inside - cell, 1)};
  const double beyond = u - inside;
  for (std::size_t i = 0; i < 4; ++i) {
    result.value[i] += beyond * result.slope[i];
    result.slope[i] /= step;
  }
  return result;
}

// Integral over the axis of the product of two functions' derivatives of one order, for all pairs.
// Products of cubics have degree six at most: four Gauss points are exact.
MatrixXd axis_gram(Index columns, double step, int order) {
  constexpr std::array<double, 4> kNode = {0.069431844202973712, 0.330009478207571868,
                                           0.669990521792428132, 0.930568155797026288};
  constexpr std::array<double, 4> kWeight = {0.173927422568726929, 0.326072577431273071,
                                             0.326072577431273071, 0.173927422568726929};
  Matrix4d cell = Matrix4d::Zero();
  for (std::size_t g = 0; g < 4; ++g) {
    const Four b = splines(kNode[g], order);
    const Eigen::Map<const Vector4d> v(b.data());
    cell += kWeight[g] * v * v.transpose();
  }
  cell *= std::pow(step, 1 - 2 * order);
  MatrixXd gram = MatrixXd::Zero(columns, columns);
  for (Index i = 0; i + 3 < columns; ++i) {
    gram.block<4, 4>(i, i) += cell;
  }
  return gram;
}

void add_kronecker(MatrixXd& sum, double factor, const MatrixXd& y_part, const MatrixXd& x_part) {
  const Index m = x_part.rows();
  for (Index i = 0; i < y_part.rows(); ++i) {
    const Index band_end = std::min(y_part.cols(), i + 4);
    for (Index j = std::max<Index>(0, i - 3); j < band_end; ++j) {
      sum.block(i * m, j * m, m, m) += (factor * y_part(i, j)) * x_part;
    }
  }
}

}  // namespace

BsplineBasis::BsplineBasis(const Rectangle& rectangle, int nx, int ny)
    : rectangle_(rectangle),
      columns_x_(nx + 3),
      columns_y_(ny + 3),
      step_x_(rectangle.width() / nx),
      step_y_(rectangle.height() / ny) {
  if (nx < 1 || ny < 1) {
    throw std::invalid_argument(fmt::format("a B-spline basis of {} x {} intervals", nx, ny));
  }
  if (!(std::isfinite(step_x_) && std::isfinite(step_y_) && step_x_ > 0.0 && step_y_ > 0.0)) {
    throw std::invalid_argument(fmt::format("a B-spline basis over a rectangle of {} x {}",
                                            rectangle.width(), rectangle.height()));
  }
}

BasisSupport BsplineBasis::at(double x, double y) const {
  const AxisSupport sx = axis_support(x, rectangle_.x_min, step_x_, columns_x_);
  const AxisSupport sy = axis_support(y, rectangle_.y_min, step_y_, columns_y_);
  BasisSupport result;
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t k = 4 * j + i;
      result.index[k] =
          (sy.first + static_cast<Index>(j)) * columns_x_ + sx.first + static_cast<Index>(i);
      result.value[k] = sx.value[i] * sy.value[j];
      result.dx[k] = sx.slope[i] * sy.value[j];
      result.dy[k] = sx.value[i] * sy.slope[j];
    }
  }
  return result;
}

VectorXd BsplineBasis::row(double x, double y) const {
  const BasisSupport support = at(x, y);
  VectorXd row = VectorXd::Zero(size());
  for (std::size_t k = 0; k < 16; ++k) row(support.index[k]) = support.value[k];
  return row;
}

ValueGradient BsplineBasis::evaluate(const Eigen::Ref<const VectorXd>& coefficients, double x,
                                     double y) const {
  if (coefficients.size() != size()) {
    throw std::invalid_argument(
        fmt::format("{} coefficients for a basis of {} functions", coefficients.size(), size()));
  }
  const BasisSupport support = at(x, y);
  ValueGradient result;
  for (std::size_t k = 0; k < 16; ++k) {
    const double c = coefficients(support.index[k]);
    result.value += c * support.value[k];
    result.dx += c * support.dx[k];
    result.dy += c * support.dy[k];
  }
  return result;
}

MatrixXd BsplineBasis::bending_penalty(int order) const {
  if (order != 2 && order != 3) {
    throw std::invalid_argument(
        fmt::format("a bending penalty of order {}; known are 2 and 3", order));
  }
  MatrixXd penalty = MatrixXd::Zero(size(), size());
  double binomial = 1.0;
  for (int in_y = 0; in_y <= order; ++in_y) {
    add_kronecker(penalty, binomial, axis_gram(columns_y_, step_y_, in_y),
                  axis_gram(columns_x_, step_x_, order - in_y));
    binomial *= static_cast<double>(order - in_y) / (in_y + 1);
  }
  return penalty;
}

MatrixXd BsplineBasis::polynomial_coefficients(int degree) const {
  if (degree != 1 && degree != 2) {
    throw std::invalid_argument(fmt::format("polynomials of degree {}; known are 1 and 2", degree));
  }
  // Marsden's identity (de Boor, chapter IX, (30)): the coefficients of a straight line are its
  // values at the knot averages; those of a parabola are its values there minus a third of the
  // squared step.
  const double step_u = 2.0 * step_x_ / rectangle_.width();
  const double step_v = 2.0 * step_y_ / rectangle_.height();
  MatrixXd polynomials(size(), degree == 1 ? 3 : 6);
  for (Index iy = 0; iy < columns_y_; ++iy) {
    for (Index ix = 0; ix < columns_x_; ++ix) {
      const double u = static_cast<double>(ix - 1) * step_u - 1.0;
      const double v = static_cast<double>(iy - 1) * step_v - 1.0;
      const Index row = iy * columns_x_ + ix;
      polynomials.row(row).head<3>() << 1.0, u, v;
      if (degree == 2) {
        polynomials.row(row).tail<3>() << u * u - step_u * step_u / 3.0, u * v,
            v * v - step_v * step_v / 3.0;
      }
    }
  }
  return polynomials;
}

}  // namespace chaintrue::interp
