// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/tensor_spline.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

namespace chaintrue::interp {
namespace {

std::vector<double> steps(double low, double step, int count) {
  std::vector<double> nodes;
  for (int i = 0; i < count; ++i) {
    nodes.push_back(low + step * i);
  }
  return nodes;
}

// The measured surface that the first proposal of this method was tried on.
double proposal(double x, double y) {
  constexpr double kPi = std::numbers::pi;
  return (2.0 * std::cos(kPi * x / 4800.0) - std::sin(kPi * y / 4800.0) + 0.8) * 1000.0;
}

template <class Function>
Eigen::MatrixXd sample(const std::vector<double>& x, const std::vector<double>& y, Function f) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(x.size()), static_cast<Eigen::Index>(y.size()));
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < y.size(); ++j) {
      values(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = f(x[i], y[j]);
    }
  }
  return values;
}

TEST(TensorSpline, AnswersTheProposalsOwnExample) {
  const auto x = steps(0, 400, 7);
  const auto y = steps(0, 300, 5);
  const TensorSpline surface(x, y, sample(x, y, proposal));
  // Octave 7.3 interp2(..., 'spline') and SciPy 1.10 RectBivariateSpline(...).ev print 2665.422998.
  EXPECT_NEAR(surface.value(100, 200), 2665.422998, 1e-6);
  EXPECT_NEAR(proposal(100, 200) - surface.value(100, 200), -0.231343, 1e-6);
}

}  // namespace
}  // namespace chaintrue::interp
