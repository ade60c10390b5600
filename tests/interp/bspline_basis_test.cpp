// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/bspline_basis.hpp"

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

constexpr std::uint64_t kBasisSeed = 3;

Eigen::VectorXd random_coefficients(const BsplineBasis& basis, std::uint64_t seed) {
  truths::Random random(seed);
  Eigen::VectorXd c(basis.size());
  for (double& value : c) value = random.uniform(-1, 1);
  return c;
}

TEST(BsplineBasis, PenaltyIsTheIntegralOfTheSquaredSecondDerivatives) {
  SCOPED_TRACE(kBasisSeed);
  const BsplineBasis basis({-2, 3, 1, 2}, 4, 3);
  const Eigen::VectorXd c = random_coefficients(basis, kBasisSeed);
  // The mid-point rule over second derivatives from differences of the analytic gradient: an
  // integration with neither the quadrature nor the second derivatives of the penalty.
  constexpr int kCells = 240;
  constexpr double kStep = 1e-5;
  double integral = 0.0;
  for (int i = 0; i < 4 * kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const double x = -2 + 5 * (i + 0.5) / (4 * kCells);
      const double y = 1 + (j + 0.5) / kCells;
      const auto gradient = [&](double px, double py) { return basis.evaluate(c, px, py); };
      const auto right = gradient(x + kStep, y);
      const auto left = gradient(x - kStep, y);
      const auto up = gradient(x, y + kStep);
      const auto down = gradient(x, y - kStep);
      const double xx = (right.dx - left.dx) / (2 * kStep);
      const double xy = (right.dy - left.dy) / (2 * kStep);
      const double yy = (up.dy - down.dy) / (2 * kStep);
      integral += xx * xx + 2 * xy * xy + yy * yy;
    }
  }
  integral *= 5.0 / (4 * kCells) * 1.0 / kCells;
  const double ours = c.dot(basis.bending_penalty(2) * c);
  EXPECT_NEAR(ours / integral, 1.0,
              1e-4);  // the mid-point rule with 80 points or more a knot interval
}

TEST(BsplineBasis, PenaltyVanishesForPlanesOnly) {
  const BsplineBasis basis(truths::kBed, 8, 4);
  const Eigen::MatrixXd p = basis.bending_penalty(2);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(p);
  const double largest = solver.eigenvalues().maxCoeff();
  EXPECT_NEAR(solver.eigenvalues()(2) / largest, 0.0, 1e-14);  // rounding
  EXPECT_GT(solver.eigenvalues()(3) / largest, 1e-6);
  EXPECT_GT(solver.eigenvalues()(0) / largest, -1e-14);
  const Eigen::MatrixXd planes = basis.polynomial_coefficients(1);
  EXPECT_LT((p * planes).cwiseAbs().maxCoeff() / largest, 1e-14);
  for (const double x : {-1300.0, -200.0, 700.0}) {
    const Eigen::VectorXd row = basis.row(x, 300.0);
    EXPECT_NEAR(row.dot(planes.col(0)), 1.0, 1e-14);
    EXPECT_NEAR(row.dot(planes.col(1)), x / 1219.2, 1e-14);
    EXPECT_NEAR(row.dot(planes.col(2)), 300.0 / 609.6, 1e-14);
  }
}

TEST(BsplineBasis, ReproducesEveryBicubic) {
  // Interpolation at as many points as functions, then elsewhere.
  const BsplineBasis basis({0, 1, 0, 2}, 2, 2);
  const auto f = [](double x, double y) { return (1 + x * x * x) * (2 - y + y * y * y); };
  Eigen::MatrixXd a(basis.size(), basis.size());
  Eigen::VectorXd b(basis.size());
  Eigen::Index row = 0;
  for (const double x : truths::even(0, 1, 5)) {
    for (const double y : truths::even(0, 2, 5)) {
      a.row(row) = basis.row(x, y).transpose();
      b(row++) = f(x, y);
    }
  }
  const Eigen::VectorXd c = a.fullPivLu().solve(b);
  for (const double x : {0.1, 0.45, 0.9}) {
    for (const double y : {0.2, 1.7}) {
      EXPECT_NEAR(basis.evaluate(c, x, y).value, f(x, y), 1e-12);  // condition about 100
    }
  }
}

TEST(BsplineBasis, GradientAgreesWithDifferencesAndTheOutsideIsC1) {
  SCOPED_TRACE(kBasisSeed);
  const BsplineBasis basis({0, 2, 0, 1}, 5, 3);
  const Eigen::VectorXd c = random_coefficients(basis, kBasisSeed + 1);
  constexpr double kStep = 1e-6;
  for (const auto& [x, y] :
       {std::pair{0.3, 0.4}, {-0.5, 0.2}, {2.7, 1.4}, {1.0, -0.3}, {2.0, 1.0}}) {
    const ValueGradient z = basis.evaluate(c, x, y);
    const double dx =
        (basis.evaluate(c, x + kStep, y).value - basis.evaluate(c, x - kStep, y).value) /
        (2 * kStep);
    const double dy =
        (basis.evaluate(c, x, y + kStep).value - basis.evaluate(c, x, y - kStep).value) /
        (2 * kStep);
    // At the corner (2, 1) the second derivative jumps: half of it times the step, of order 1e-4.
    EXPECT_NEAR(z.dx, dx, 1e-4);
    EXPECT_NEAR(z.dy, dy, 1e-4);
  }
  const double edge = basis.evaluate(c, 2.0, 0.3).dx;
  EXPECT_NEAR(basis.evaluate(c, 2.9, 0.3).dx, edge, 1e-13);
}

}  // namespace
}  // namespace chaintrue::interp
