// SPDX-License-Identifier: GPL-3.0-or-later
// Quintic splines, missing nodes, and the value of a surface outside its measured region.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "interp/measured_region.hpp"
#include "interp/missing_nodes.hpp"
#include "interp/planner_nodes.hpp"
#include "interp/tensor_spline.hpp"
#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

using truths::even;
using truths::kBed;
using truths::sample;

constexpr std::uint64_t kSurfacesSeed = 12;

TEST(TensorSpline, OfDegreeFiveBeatsTheBicubicOnSmoothDataAsTheStudyFound) {
  const auto x = even(kBed.x_min, kBed.x_max, 13);
  const auto y = even(kBed.y_min, kBed.y_max, 7);
  const auto truth = [](double a, double b) { return truths::wrapped_chain(a, b, 1.0); };
  const TensorSpline surface(std::make_shared<TensorAxes>(x, y, TensorEnds{}, 5),
                             sample(x, y, truth));
  EXPECT_NEAR(truths::largest_error(surface, truth), 0.0558,
              0.0005);  // the study's figure, three digits
}

TEST(MissingNodes, FillSumsOverTheAxesAndCubicsExactly) {
  const auto x = even(0, 6, 7);
  const auto y = even(0, 4, 5);
  const auto sum = [](double a, double b) { return std::exp(a) + 1.0 / (1.0 + b * b); };
  const auto cubic = [](double a, double b) { return 1 + a - 0.1 * a * a * a + b * b * a; };
  // Rounding of values up to 400 for the sum, which is no cubic; a cubic along each line leaves no doubt.
  for (const auto& [whole, rounding, most_doubt] :
       {std::tuple(sample(x, y, sum), 1e-9, 1e9), {sample(x, y, cubic), 1e-12, 1e-12}}) {
    for (Eigen::Index ix = 0; ix < 7; ++ix) {
      for (Eigen::Index iy = 0; iy < 5; ++iy) {
        SCOPED_TRACE(testing::Message() << rounding << ": " << ix << " " << iy);
        Eigen::MatrixXd holed = whole;
        holed(ix, iy) = NAN;
        const auto grid = fill_missing(x, y, holed);
        ASSERT_TRUE(grid);
        ASSERT_EQ(grid->filled.size(), 1U);
        EXPECT_NEAR(grid->values(ix, iy), whole(ix, iy), rounding);
        EXPECT_GE(grid->filled[0].doubt, 0.0);
        EXPECT_LE(grid->filled[0].doubt, most_doubt);
      }
    }
  }
}

TEST(MissingNodes, FillASmoothResidualToTwoHundredths) {
  const auto x = even(kBed.x_min, kBed.x_max, 9);
  const auto y = even(kBed.y_min, kBed.y_max, 5);
  // The part of the unmodelled 0.8 mm that remains after calibration: its higher half.
  const auto residual = [](double a, double b) {
    return 0.1 * std::sin(a / 500 + 0.3) * std::cos(b / 400);
  };
  const Eigen::MatrixXd whole = sample(x, y, residual);
  for (const auto& [ix, iy] : {std::pair{4, 2}, {4, 0}, {0, 0}, {8, 4}}) {
    Eigen::MatrixXd holed = whole;
    holed(ix, iy) = NAN;
    const auto grid = fill_missing(x, y, holed);
    ASSERT_TRUE(grid);
    const TensorSpline surface(x, y, grid->values);
    EXPECT_LE(truths::largest_error(surface, residual), 0.02) << ix << " " << iy;
  }
}

TEST(MissingNodes, UnreachableOnesLeaveTheGridUnfilled) {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(4, 4);
  values(1, 0) = values(2, 0) = values(1, 1) = values(1, 2) = NAN;
  EXPECT_FALSE(fill_missing(even(0, 3, 4), even(0, 3, 4), values));
  values(1, 1) = values(1, 2) = 0.0;
  EXPECT_TRUE(fill_missing(even(0, 3, 4), even(0, 3, 4), values));
}

class Tilted final : public Surface {
 public:
  ValueGradient at(double x, double y) const override {
    return {1 + x * x + 0.5 * x * y + std::sin(y), 2 * x + 0.5 * y, 0.5 * x + std::cos(y)};
  }
  Rectangle domain() const override { return {-1, 1, -1, 1}; }
};

TEST(ConvexHull, HoldsItsPointsAndFindsTheNearest) {
  SCOPED_TRACE(kSurfacesSeed);
  truths::Random random(kSurfacesSeed + 1);
  std::vector<PlanePoint> points;
  for (int i = 0; i < 60; ++i) points.push_back({random.uniform(-1, 1), random.uniform(-1, 1)});
  const ConvexHull hull(points);
  for (const PlanePoint& p : points) EXPECT_TRUE(hull.contains(p.x, p.y));
  EXPECT_FALSE(hull.contains(1.5, 0));
  // By brute force along the boundary.
  for (int k = 0; k < 20; ++k) {
    const double angle = 2 * std::numbers::pi * k / 20;
    const PlanePoint p{2 * std::cos(angle), 2 * std::sin(angle)};
    double best = 1e9;
    for (std::size_t i = 0; i < hull.corners().size(); ++i) {
      const PlanePoint& a = hull.corners()[i];
      const PlanePoint& b = hull.corners()[(i + 1) % hull.corners().size()];
      for (double t = 0; t <= 1; t += 1e-4) {
        best = std::min(best, std::hypot(p.x - a.x - t * (b.x - a.x), p.y - a.y - t * (b.y - a.y)));
      }
    }
    EXPECT_NEAR(hull.nearest(p.x, p.y).distance, best, 1e-7);  // the step along an edge, squared
  }
  EXPECT_THROW(ConvexHull({{0, 0}, {1, 1}, {2, 2}}), std::invalid_argument);
}

TEST(MeasuredRegion, EveryPolicyIsContinuousAndItsGradientTrue) {
  const Tilted surface;
  const ConvexHull hull({{-1, -1}, {1, -1}, {1, 0.5}, {0, 1}, {-1, 1}});
  for (const OutsidePolicy outside :
       {OutsidePolicy::fade, OutsidePolicy::linear, OutsidePolicy::clamp}) {
    const RegionPolicy policy{outside, 0.1, 0.6};
    const auto value = [&](double x, double y) {
      return evaluate(surface, hull, policy, {x, y}).value;
    };
    for (double angle = 0.05; angle < 6.28; angle += 0.1) {
      double before = value(0, 0);
      for (double r = 0.002; r < 3; r += 0.002) {
        const double x = r * std::cos(angle);
        const double y = r * std::sin(angle);
        const double here = value(x, y);
        EXPECT_LT(std::abs(here - before), 0.03);  // slopes stay below 15: no jump
        before = here;
      }
    }
    constexpr double kStep = 1e-6;
    for (const auto& [x, y] :
         {std::pair{1.2, 0.1}, {1.4, -1.3}, {0.8, 1.0}, {-0.4, 1.35}, {0.2, 0.1}}) {
      const ValueGradient z = evaluate(surface, hull, policy, {x, y});
      EXPECT_NEAR(z.dx, (value(x + kStep, y) - value(x - kStep, y)) / (2 * kStep), 1e-6);
      EXPECT_NEAR(z.dy, (value(x, y + kStep) - value(x, y - kStep)) / (2 * kStep), 1e-6);
    }
  }
}

TEST(MeasuredRegion, FadesToZero) {
  const Tilted surface;
  const ConvexHull hull({{-1, -1}, {1, -1}, {1, 1}, {-1, 1}});
  const RegionPolicy fade{OutsidePolicy::fade, 0.1, 0.6};
  EXPECT_EQ(evaluate(surface, hull, fade, {3, 3}).value, 0.0);
  EXPECT_EQ(evaluate(surface, hull, fade, {NAN, 0.0}).value, 0.0);
}

TEST(PlannerNodes, FollowChebyshevLobatto) {
  const auto nodes = chebyshev_lobatto(-1219.2, 1219.2, 7);
  ASSERT_EQ(nodes.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(nodes[i], -1219.2 * std::cos(std::numbers::pi * static_cast<double>(i) / 6), 1e-9);
    EXPECT_EQ(nodes[i], -nodes[6 - i]);
  }
  EXPECT_THROW((void)chebyshev_lobatto(1, 1, 5), std::invalid_argument);
  const GridShape shape = grid_shape(2438.4, 1219.2, 28);
  EXPECT_EQ(shape.columns, 7);
  EXPECT_EQ(shape.rows, 4);
}

}  // namespace
}  // namespace chaintrue::interp
