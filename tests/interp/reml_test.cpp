// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/reml.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "interp/bspline_basis.hpp"

namespace chaintrue::interp {
namespace {

TEST(Reml, SmoothsANoisySurface) {
  std::mt19937_64 random(7);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const BsplineBasis basis({-1, 1, -1, 1}, 6, 6);
  PenalisedProblem problem(basis.size());
  Eigen::MatrixXd design(200, basis.size());
  Eigen::VectorXd response(200);
  const double sigma = 0.1;
  for (int i = 0; i < 200; ++i) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    double noise = -6.0;
    for (int k = 0; k < 12; ++k) noise += uniform();
    design.row(i) = basis.row(x, y).transpose() / sigma;
    response(i) = (std::sin(2 * x + y) + sigma * noise) / sigma;
  }
  problem.add_rows(design, response);
  problem.penalties.push_back({0, basis.thin_plate_penalty(), basis.thin_plate_rank()});
  problem.noise = {NoiseKnowledge::unknown, 0};
  const auto fit = fit_penalised(problem);
  ASSERT_TRUE(fit.has_value());
  EXPECT_NEAR(fit->sigma2, 1.0, 0.3);
  for (double x : {-0.7, 0.1, 0.8}) {
    EXPECT_NEAR(basis.row(x, 0.3).dot(fit->coefficients), std::sin(2 * x + 0.3), 0.15);
  }
}

}  // namespace
}  // namespace chaintrue::interp
