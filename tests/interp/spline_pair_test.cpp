// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/spline_pair.hpp"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

using truths::kBed;

constexpr std::uint64_t kPairSeed = 97;

// On even lines and on lines so uneven that a mean interval spans several.
TEST(SplinePair, EqualsTwoSplinesInsideAndOutside) {
  SCOPED_TRACE(kPairSeed);
  truths::Random random(kPairSeed);
  const std::vector<double> uneven = {kBed.x_min, -1200.0, -1190.0, 0.0, 900.0, 910.0, kBed.x_max};
  for (const auto& x : {truths::even(kBed.x_min, kBed.x_max, 7), uneven}) {
    const auto y = random.nodes(4, kBed.y_min, kBed.y_max);
    const auto axes = std::make_shared<const TensorAxes>(x, y);
    const auto chains = [&](double side) {
      return TensorSpline(axes, truths::sample(x, y, [side](double a, double b) {
                            return truths::wrapped_chain(a, b, side);
                          }));
    };
    const TensorSpline left = chains(-1.0);
    const TensorSpline right = chains(1.0);
    const SplinePair pair(left, right);
    std::vector<PlanePoint> points;
    for (int k = 0; k < 2000; ++k) {
      points.push_back({random.uniform(kBed.x_min - 100.0, kBed.x_max + 100.0),
                        random.uniform(kBed.y_min - 100.0, kBed.y_max + 100.0)});
    }
    for (const double node : x) points.push_back({node, y[1]});
    for (const PlanePoint& p : points) {
      const PairGradient z = pair.at(p.x, p.y);
      const TensorSpline* splines[] = {&left, &right};
      for (std::size_t side = 0; side < 2; ++side) {
        const ValueGradient expected = splines[side]->at(p.x, p.y);
        // Rounding of 3000 mm; a hundred times as much where a narrow end cell continues far out.
        EXPECT_NEAR(z.value[side], expected.value, 1e-8);
        EXPECT_NEAR(z.dx[side], expected.dx, 1e-8);
        EXPECT_NEAR(z.dy[side], expected.dy, 1e-8);
      }
    }
  }
}

TEST(SplinePair, RefusesOtherAxesAndQuintics) {
  const TensorSpline a({0, 1, 3}, {0, 1}, Eigen::MatrixXd::Zero(3, 2));
  const TensorSpline b({0, 1, 2}, {0, 1}, Eigen::MatrixXd::Zero(3, 2));
  EXPECT_THROW(SplinePair(a, b), std::invalid_argument);
  const auto x = truths::even(0.0, 1.0, 6);
  const TensorSpline quintic(std::make_shared<TensorAxes>(x, x, TensorEnds{}, 5),
                             Eigen::MatrixXd::Zero(6, 6));
  EXPECT_THROW(SplinePair(quintic, quintic), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::interp
