// SPDX-License-Identifier: GPL-3.0-or-later
// The part of a spline surface that points determine, compared with the penalty's own algebra.
#include "grid/estimation/observed_subspace.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "grid/random.hpp"

namespace chaintrue::grid {
namespace {

constexpr std::uint64_t kSeed = 5;

std::vector<model::MarkPoint> places(int count) {
  Random random(kSeed);
  std::vector<model::MarkPoint> marks;
  for (int i = 0; i < count; ++i)
    marks.push_back({2400.0 * random.uniform() - 1200.0, 1200.0 * random.uniform() - 600.0});
  marks[1] = marks[0];  // a repeat
  return marks;
}

class ObservedSubspaceOf : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(ObservedSubspaceOf, HasThePriorAndTheRowsOfTheSplines) {
  SCOPED_TRACE(kSeed);
  const auto [points, order] = GetParam();
  const interp::BsplineBasis basis({-1200.0, 1200.0, -600.0, 600.0}, 7, 4);
  const auto marks = places(points);
  const ObservedSubspace observed(basis, order, marks);
  EXPECT_EQ(observed.penalised.cols(), std::min<Eigen::Index>(points, basis.size()));
  const Eigen::MatrixXd b = observed.penalised;
  const Eigen::MatrixXd null_space = observed.null_space;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::RowVectorXd phi = basis.row(marks[i].x_mm, marks[i].y_mm).transpose();
    const double size = observed.penalised_rows.cwiseAbs().maxCoeff();
    // Rounding of sums of 70 terms.
    EXPECT_LT((phi * b - observed.penalised_rows.row(at)).cwiseAbs().maxCoeff(), 1e-11 * size);
    EXPECT_LT((phi * observed.polynomials - observed.polynomial_rows.row(at)).cwiseAbs().maxCoeff(),
              1e-12);
    if (null_space.cols() > 0) {
      EXPECT_LT((phi * null_space).cwiseAbs().maxCoeff(), 1e-11 * size);
    }
    EXPECT_NEAR(observed.squares[at], phi.squaredNorm(), 1e-14);
  }
  // The pseudo-inverse G of P: P G P = P and no polynomial in G.
  const Eigen::MatrixXd p = basis.bending_penalty(order);
  const Eigen::MatrixXd g = b * b.transpose() + null_space * null_space.transpose();
  const Eigen::MatrixXd back = p * g * p;
  EXPECT_LT((back - p).cwiseAbs().maxCoeff(), 1e-9 * p.cwiseAbs().maxCoeff());
  EXPECT_LT((observed.polynomials.transpose() * g).cwiseAbs().maxCoeff(),
            1e-9 * g.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(FewAndMany, ObservedSubspaceOf,
                         testing::Combine(testing::Values(12, 28, 69, 70, 120),
                                          testing::Values(2, 3)));

}  // namespace
}  // namespace chaintrue::grid
