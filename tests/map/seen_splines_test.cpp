// SPDX-License-Identifier: GPL-3.0-or-later
// What points see of a spline surface, against the penalty's own algebra.
#include "grid/map/seen_splines.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <vector>

#include "grid/synthetic/random.hpp"

namespace chaintrue::grid {
namespace {

constexpr std::uint64_t kSeed = 5;

std::vector<model::BedPoint> places(int count) {
  synthetic::Random random(kSeed);
  std::vector<model::BedPoint> marks;
  for (int i = 0; i < count; ++i)
    marks.push_back({2400.0 * random.uniform() - 1200.0, 1200.0 * random.uniform() - 600.0});
  marks[1] = marks[0];  // a repeat
  return marks;
}

class SeenSplinesOf : public testing::TestWithParam<std::tuple<int, int>> {};

TEST_P(SeenSplinesOf, AreThePriorAndTheRowsOfTheSplines) {
  SCOPED_TRACE(kSeed);
  const auto [points, order] = GetParam();
  const interp::BsplineBasis basis({-1200.0, 1200.0, -600.0, 600.0}, 7, 4);
  const auto marks = places(points);
  const SeenSplines seen(basis, order, marks);
  EXPECT_EQ(seen.bends(), std::min<Eigen::Index>(points, basis.size()));
  const Eigen::MatrixXd b = seen.bend_coefficients();
  const Eigen::MatrixXd unseen = seen.unseen_coefficients();
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::RowVectorXd phi = basis.row(marks[i].x_mm, marks[i].y_mm).transpose();
    const double size = seen.bend_rows().cwiseAbs().maxCoeff();
    // Rounding of sums of 70 terms.
    EXPECT_LT((phi * b - seen.bend_rows().row(at)).cwiseAbs().maxCoeff(), 1e-11 * size);
    EXPECT_LT((phi * seen.polynomial_coefficients() - seen.polynomial_rows().row(at))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
    if (unseen.cols() > 0) {
      EXPECT_LT((phi * unseen).cwiseAbs().maxCoeff(), 1e-11 * size);
    }
    EXPECT_NEAR(seen.squares()[at], phi.squaredNorm(), 1e-14);
  }
  // The pseudo-inverse G of P: P G P = P and no polynomial in G.
  const Eigen::MatrixXd p = basis.bending_penalty(order);
  const Eigen::MatrixXd g = b * b.transpose() + unseen * unseen.transpose();
  const Eigen::MatrixXd back = p * g * p;
  EXPECT_LT((back - p).cwiseAbs().maxCoeff(), 1e-9 * p.cwiseAbs().maxCoeff());
  EXPECT_LT((seen.polynomial_coefficients().transpose() * g).cwiseAbs().maxCoeff(),
            1e-9 * g.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(FewAndMany,
                         SeenSplinesOf,
                         testing::Combine(testing::Values(12, 28, 69, 70, 120),
                                          testing::Values(2, 3)));

}  // namespace
}  // namespace chaintrue::grid
