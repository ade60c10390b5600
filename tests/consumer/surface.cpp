// SPDX-License-Identifier: GPL-3.0-or-later
// surface: a bicubic spline through the values at uneven nodes is exact for a cubic.
#include <fmt/format.h>

#include <chaintrue/interp.hpp>

int main() {
  const std::vector<double> x = {0.0, 1.0, 3.0, 4.0};
  const std::vector<double> y = {0.0, 2.0, 3.0, 5.0};
  Eigen::MatrixXd values(4, 4);
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const double at_x = x[static_cast<std::size_t>(i)];
      values(i, j) = at_x * at_x * at_x * y[static_cast<std::size_t>(j)];
    }
  }
  const chaintrue::interp::TensorSpline surface(x, y, values);
  fmt::print("{:.9f}\n", surface.at(2.0, 1.0).value);
}
