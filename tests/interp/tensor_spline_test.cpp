// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/tensor_spline.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Dense>

#include "interp/planner_nodes.hpp"
#include "tests/interp/truths.hpp"
#include "tests/support/refusal.hpp"

namespace chaintrue::interp {
namespace {

using testing_support::refusal_of;
using truths::even;
using truths::kBed;
using truths::sample;

constexpr std::uint64_t kTensorSeed = 41;

TEST(TensorSpline, ReproducesTheExampleOfTheProposal) {
  const auto x = even(0, 2400, 7);
  const auto y = even(0, 1200, 5);
  const TensorSpline surface(x, y, sample(x, y, truths::proposal));
  // Octave 7.3 interp2(..., 'spline') and SciPy 1.10 RectBivariateSpline(...).ev print 2665.422998.
  EXPECT_NEAR(surface.at(100, 200).value, 2665.422998, 1e-6);
  EXPECT_NEAR(truths::proposal(100, 200) - surface.at(100, 200).value, -0.231343, 1e-6);
  // ALGLIB 3.19 and GSL 2.7.1 on the same grid.
  const TensorEnds parabolic = {{EndCondition::parabolic, EndCondition::parabolic},
                                {EndCondition::parabolic, EndCondition::parabolic}};
  const TensorEnds natural = {{EndCondition::natural, EndCondition::natural},
                              {EndCondition::natural, EndCondition::natural}};
  const Eigen::MatrixXd z = sample(x, y, truths::proposal);
  EXPECT_NEAR(TensorSpline(x, y, z, parabolic).at(100, 200).value, 2664.808680, 1e-6);
  EXPECT_NEAR(TensorSpline(x, y, z, natural).at(100, 200).value, 2659.051508, 1e-6);
}

/// The power coefficients about `from` of the cubic through four values of f in a cell.
template <class Line>
Eigen::Vector4d cubic_of(const Line& f, double from, double to) {
  Eigen::Matrix4d powers;
  Eigen::Vector4d values;
  for (int i = 0; i < 4; ++i) {
    const double t = (to - from) * (i + 0.5) / 4.0;
    powers.row(i) << 1.0, t, t * t, t * t * t;
    values(i) = f(from + t);
  }
  return powers.fullPivLu().solve(values);
}

/// A line of the surface is a cubic in each cell, with a continuous second derivative and its end conditions.
template <class Line>
void expect_spline(const Line& f, const std::vector<double>& x, const AxisEnds& ends) {
  std::vector<Eigen::Vector4d> cells;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) cells.push_back(cubic_of(f, x[i], x[i + 1]));
  constexpr double kTolerance = 1e-8;  // third derivatives of 1e3 from values to 1e-14
  // Value and derivatives of a cell at its end.
  const auto at_end = [&](std::size_t i) {
    const double h = x[i + 1] - x[i];
    Eigen::Matrix4d shift;
    shift << 1, h, h * h, h * h * h, 0, 1, 2 * h, 3 * h * h, 0, 0, 1, 3 * h, 0, 0, 0, 1;
    return Eigen::Vector4d(shift * cells[i]);
  };
  for (std::size_t i = 1; i < cells.size(); ++i)
    EXPECT_LT((at_end(i - 1) - cells[i]).head(3).cwiseAbs().maxCoeff(), kTolerance) << i;
  const auto defect = [](EndCondition condition, const Eigen::Vector4d& cell,
                         const Eigen::Vector4d& inner) {
    switch (condition) {
      case EndCondition::not_a_knot:
        return cell(3) - inner(3);
      case EndCondition::natural:
        return cell(2);
      case EndCondition::parabolic:
        return cell(3);
      case EndCondition::clamped:
        break;
    }
    return cell(1);
  };
  EXPECT_NEAR(defect(ends.low, cells.front(), cells[1]), 0.0, kTolerance);
  EXPECT_NEAR(defect(ends.high, at_end(cells.size() - 1), cells[cells.size() - 2]), 0.0,
              kTolerance);
}

TEST(TensorSpline, IsTheSplineOfEveryPairOfEnds) {
  SCOPED_TRACE(kTensorSeed);
  truths::Random random(kTensorSeed);
  const EndCondition all[] = {EndCondition::not_a_knot, EndCondition::natural,
                              EndCondition::parabolic, EndCondition::clamped};
  for (const EndCondition low : all) {
    for (const EndCondition high : all) {
      const auto x = random.nodes(7, -1.2, 1.2);
      const auto y = random.nodes(4, -0.6, 0.6);
      const TensorEnds ends = {{low, high}, {high, low}};
      const Eigen::MatrixXd z = sample(x, y, [&](double, double) { return random.uniform(-1, 1); });
      const TensorSpline surface(x, y, z, ends);
      for (int k = 0; k < 10; ++k) {
        const double px = random.uniform(-1.2, 1.2);
        const double py = random.uniform(-0.6, 0.6);
        expect_spline([&](double at) { return surface.at(at, py).value; }, x, ends.x);
        expect_spline([&](double at) { return surface.at(px, at).value; }, y, ends.y);
        EXPECT_NEAR(surface.at(px, py).value,
                    surface.cardinal_weights(px, py).cwiseProduct(z).sum(),
                    1e-11);  // rounding of sums of 28 terms
      }
    }
  }
}

TEST(TensorSpline, NotAKnotReproducesEveryBicubicAlsoOutside) {
  SCOPED_TRACE(kTensorSeed);
  truths::Random random(kTensorSeed + 2);
  Eigen::Matrix4d c;
  for (Eigen::Index i = 0; i < 16; ++i) c(i) = random.uniform(-1, 1);
  const auto powers = [](double t) { return Eigen::Vector4d(1, t, t * t, t * t * t); };
  const auto slopes = [](double t) { return Eigen::Vector4d(0, 1, 2 * t, 3 * t * t); };
  const auto cubic = [&](double x, double y) { return powers(x).dot(c * powers(y)); };
  const auto x = random.nodes(6, -1, 1);
  const auto y = random.nodes(4, -1, 1);
  const TensorSpline surface(x, y, sample(x, y, cubic));
  for (int k = 0; k < 100; ++k) {
    const double px = random.uniform(-1.5, 1.5);
    const double py = random.uniform(-1.5, 1.5);
    const ValueGradient z = surface.at(px, py);
    EXPECT_NEAR(z.value, cubic(px, py), 1e-11);  // rounding, amplified outside
    EXPECT_NEAR(z.dx, slopes(px).dot(c * powers(py)), 1e-11);
    EXPECT_NEAR(z.dy, powers(px).dot(c * slopes(py)), 1e-11);
  }
}

TEST(TensorSpline, ClampedWithItsOwnSlopesReproducesEveryBicubic) {
  const auto f = [](double x, double y) { return (1 + x - x * x * x) * (2 - y * y + y * y * y); };
  const auto fx = [](double x, double y) { return (1 - 3 * x * x) * (2 - y * y + y * y * y); };
  const auto fy = [](double x, double y) { return (1 + x - x * x * x) * (-2 * y + 3 * y * y); };
  const std::vector<double> x = {-1, -0.2, 0.3, 1.1};
  const std::vector<double> y = {-0.5, 0.1, 0.4, 0.9};
  const EdgeSlopes slopes = {sample({x.front(), x.back()}, y, fx),
                             sample(x, {y.front(), y.back()}, fy)};
  const TensorEnds ends = {{EndCondition::clamped, EndCondition::clamped},
                           {EndCondition::clamped, EndCondition::clamped}};
  const TensorSpline surface(x, y, sample(x, y, f), ends, slopes);
  for (double px = -1; px <= 1.1; px += 0.13) {
    for (double py = -0.5; py <= 0.9; py += 0.11) {
      EXPECT_NEAR(surface.at(px, py).value, f(px, py), 1e-13);  // rounding
    }
  }
}

TEST(TensorSpline, TwoAndThreeNodesGiveTheLineAndTheParabola) {
  const auto f = [](double x, double y) { return (1 + 2 * x) * (3 - y + 0.5 * y * y); };
  const std::vector<double> x = {-1, 2};
  const std::vector<double> y = {0, 0.7, 2};
  const TensorSpline surface(x, y, sample(x, y, f));
  for (double px = -1; px <= 2; px += 0.3) {
    for (double py = 0; py <= 2; py += 0.2) {
      EXPECT_NEAR(surface.at(px, py).value, f(px, py), 1e-13);  // rounding
    }
  }
}

// A machine without sag, interpolated directly. rows x columns, largest error of either chain.
double direct_error(const std::vector<double>& x, const std::vector<double>& y) {
  double worst = 0.0;
  for (const double side : {-1.0, 1.0}) {
    const auto truth = [&](double px, double py) { return truths::wrapped_chain(px, py, side); };
    const TensorSpline surface(x, y, sample(x, y, truth));
    worst = std::max(worst, truths::largest_error(surface, truth));
  }
  return worst;
}

struct Sampling {
  int rows, columns;
  double even_mm, chebyshev_mm;
};

class DirectInterpolation : public testing::TestWithParam<Sampling> {};

TEST_P(DirectInterpolation, ErrsAsMuchAsTheOutsideStudyFound) {
  const Sampling& s = GetParam();
  const double plain =
      direct_error(even(kBed.x_min, kBed.x_max, s.columns), even(kBed.y_min, kBed.y_max, s.rows));
  // The study's figures have three digits.
  EXPECT_NEAR(plain, s.even_mm, 0.005);
  const double chebyshev = direct_error(chebyshev_lobatto(kBed.x_min, kBed.x_max, s.columns),
                                        chebyshev_lobatto(kBed.y_min, kBed.y_max, s.rows));
  EXPECT_LE(chebyshev, s.chebyshev_mm);
  RecordProperty("even_um", static_cast<int>(1000 * plain));
  RecordProperty("chebyshev_um", static_cast<int>(1000 * chebyshev));
}

INSTANTIATE_TEST_SUITE_P(Grids, DirectInterpolation,
                         testing::Values(Sampling{4, 7, 4.21, 1.85}, Sampling{5, 9, 1.78, 0.62},
                                         Sampling{7, 13, 0.50, 0.08}),
                         [](const testing::TestParamInfo<Sampling>& grid) {
                           return std::to_string(grid.param.rows) + "x" +
                                  std::to_string(grid.param.columns);
                         });

TEST(TensorSpline, RefusesInvalidGrids) {
  const Eigen::MatrixXd z = Eigen::MatrixXd::Zero(3, 2);
  EXPECT_EQ(refusal_of([&] { TensorSpline({0, 1}, {0, 1}, z); }), "3 x 2 values for 2 x 2 nodes");
  EXPECT_EQ(refusal_of([&] {
              TensorSpline({0, 1, 1}, {0, 1}, z);
            }),
            "nodes of a spline axis must increase: node 1 is 1, node 2 is 1");
  EXPECT_EQ(refusal_of([&] {
              TensorSpline({0}, {0, 1}, z);
            }),
            "a spline axis needs at least 2 nodes, has 1");
  EXPECT_EQ(refusal_of([&] {
              TensorSpline({0, 1, NAN}, {0, 1}, z);
            }),
            "node 2 of a spline axis is nan");
  Eigen::MatrixXd hole = z;
  hole(1, 1) = NAN;
  EXPECT_EQ(refusal_of([&] {
              TensorSpline({0, 1, 2}, {0, 1}, hole);
            }),
            "a value of the grid is not finite");
  EdgeSlopes slopes;
  slopes.x = Eigen::MatrixXd::Zero(2, 3);
  EXPECT_EQ(refusal_of([&] {
              TensorSpline({0, 1, 2}, {0, 1}, z, {}, slopes);
            }),
            "2 x 3 slopes along x, where the nodes need 2 x 2");
}

}  // namespace
}  // namespace chaintrue::interp
