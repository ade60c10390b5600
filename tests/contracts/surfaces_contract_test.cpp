// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of every way to interpolate a full grid: a new one is a line of kSurfaceMethods.
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <memory>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "interp/tensor_spline.hpp"
#include "tests/support/in_threads.hpp"
#include "tests/support/random.hpp"

namespace chaintrue::interp {

namespace {

using Nodes = std::vector<double>;

/// `build` throws std::invalid_argument as TensorSpline does.
struct SurfaceMethod {
  std::string_view id;
  int exact_degree;  ///< polynomials of this degree in x times the same in y are reproduced
  std::unique_ptr<Surface> (*build)(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values);
};

template <EndCondition kEnd>
std::unique_ptr<Surface> bicubic(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values) {
  return std::make_unique<TensorSpline>(x, y, values, TensorEnds{{kEnd, kEnd}, {kEnd, kEnd}});
}

std::unique_ptr<Surface> quintic(const Nodes& x, const Nodes& y, const Eigen::MatrixXd& values) {
  return std::make_unique<TensorSpline>(std::make_shared<TensorAxes>(x, y, TensorEnds{}, 5),
                                        values);
}

constexpr std::array kSurfaceMethods = {
    SurfaceMethod{"not_a_knot", 3, bicubic<EndCondition::not_a_knot>},
    SurfaceMethod{"natural", 1, bicubic<EndCondition::natural>},
    SurfaceMethod{"parabolic", 2, bicubic<EndCondition::parabolic>},
    SurfaceMethod{"clamped", 0, bicubic<EndCondition::clamped>},
    SurfaceMethod{"quintic", 5, quintic},
};

void PrintTo(const SurfaceMethod& method, std::ostream* out) { *out << method.id; }

constexpr std::uint64_t kSeed = 1234;

using testing_support::Random;

struct Grid {
  std::vector<double> x, y;
  Eigen::MatrixXd values;
};

Grid uneven_grid(Random& random, int nx, int ny) {
  Grid grid;
  for (int i = 0; i < nx; ++i) grid.x.push_back(i + random.uniform(-0.3, 0.3));
  for (int j = 0; j < ny; ++j) grid.y.push_back(0.5 * j + random.uniform(-0.1, 0.1));
  grid.values.resize(nx, ny);
  for (double& value : grid.values.reshaped()) value = random.uniform(-1, 1);
  return grid;
}

class SurfaceContract : public testing::TestWithParam<SurfaceMethod> {
 protected:
  SurfaceContract() : trace_(__FILE__, __LINE__, std::to_string(kSeed)) {}
  Random random_{kSeed};

 private:
  testing::ScopedTrace trace_;
};

TEST_P(SurfaceContract, PassesThroughItsValues) {
  for (const auto& [nx, ny] : {std::pair{2, 2}, {3, 4}, {7, 4}, {9, 6}}) {
    const Grid grid = uneven_grid(random_, nx, ny);
    const auto surface = GetParam().build(grid.x, grid.y, grid.values);
    for (int i = 0; i < nx; ++i) {
      for (int j = 0; j < ny; ++j) {
        const auto a = static_cast<std::size_t>(i);
        const auto b = static_cast<std::size_t>(j);
        EXPECT_NEAR(surface->at(grid.x[a], grid.y[b]).value, grid.values(i, j), 1e-11);  // rounding
      }
    }
    EXPECT_EQ(surface->domain().x_min, grid.x.front());
    EXPECT_EQ(surface->domain().y_max, grid.y.back());
  }
}

TEST_P(SurfaceContract, ReproducesThePolynomialsItClaims) {
  Grid grid = uneven_grid(random_, 8, 7);
  const int degree = GetParam().exact_degree;
  for (int px = 0; px <= degree; ++px) {
    for (int py = 0; py <= degree; ++py) {
      const auto polynomial = [&](double x, double y) {
        return std::pow(x / 7, px) * std::pow(y / 3, py);
      };
      for (Eigen::Index i = 0; i < 8; ++i) {
        for (Eigen::Index j = 0; j < 7; ++j) {
          grid.values(i, j) =
              polynomial(grid.x[static_cast<std::size_t>(i)], grid.y[static_cast<std::size_t>(j)]);
        }
      }
      const auto surface = GetParam().build(grid.x, grid.y, grid.values);
      for (int k = 0; k < 20; ++k) {
        const double x = random_.uniform(grid.x.front(), grid.x.back());
        const double y = random_.uniform(grid.y.front(), grid.y.back());
        EXPECT_NEAR(surface->at(x, y).value, polynomial(x, y), 1e-12)
            << px << " " << py;  // rounding
      }
    }
  }
}

TEST_P(SurfaceContract, GradientIsTheDerivativeOfTheValue) {
  const Grid grid = uneven_grid(random_, 7, 6);
  const auto surface = GetParam().build(grid.x, grid.y, grid.values);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 100; ++k) {
    const double x = random_.uniform(grid.x.front() - 0.2, grid.x.back() + 0.2);
    const double y = random_.uniform(grid.y.front() - 0.1, grid.y.back() + 0.1);
    const ValueGradient z = surface->at(x, y);
    const auto value = [&](double px, double py) { return surface->at(px, py).value; };
    // The step squared times third derivatives of up to 1e3.
    EXPECT_NEAR(z.dx, (value(x + kStep, y) - value(x - kStep, y)) / (2 * kStep), 1e-6);
    EXPECT_NEAR(z.dy, (value(x, y + kStep) - value(x, y - kStep)) / (2 * kStep), 1e-6);
  }
}

TEST_P(SurfaceContract, IsLinearInItsValues) {
  const Grid a = uneven_grid(random_, 7, 4);
  const Grid b = uneven_grid(random_, 7, 4);
  const auto first = GetParam().build(a.x, a.y, a.values);
  const auto second = GetParam().build(a.x, a.y, b.values);
  const auto sum = GetParam().build(a.x, a.y, 2.0 * a.values - 0.5 * b.values);
  for (int k = 0; k < 50; ++k) {
    const double x = random_.uniform(a.x.front(), a.x.back());
    const double y = random_.uniform(a.y.front(), a.y.back());
    EXPECT_NEAR(sum->at(x, y).value, 2.0 * first->at(x, y).value - 0.5 * second->at(x, y).value,
                1e-12);  // rounding
  }
}

TEST_P(SurfaceContract, TurnsWithItsAxes) {
  const Grid grid = uneven_grid(random_, 6, 7);
  const auto surface = GetParam().build(grid.x, grid.y, grid.values);
  const auto turned = GetParam().build(grid.y, grid.x, grid.values.transpose());
  for (int k = 0; k < 50; ++k) {
    const double x = random_.uniform(grid.x.front(), grid.x.back());
    const double y = random_.uniform(grid.y.front(), grid.y.back());
    EXPECT_NEAR(surface->at(x, y).value, turned->at(y, x).value, 1e-11);  // rounding
    EXPECT_NEAR(surface->at(x, y).dx, turned->at(y, x).dy, 1e-11);
  }
}

TEST_P(SurfaceContract, GivesTheSameBitsInAnyThread) {
  const Grid grid = uneven_grid(random_, 7, 4);
  const auto surface = GetParam().build(grid.x, grid.y, grid.values);
  std::vector<ValueGradient> alone;
  for (int k = 0; k < 500; ++k) alone.push_back(surface->at(0.013 * k, 0.003 * k));
  std::vector<std::vector<ValueGradient>> together(4);
  std::vector<std::function<void()>> asking;
  for (auto& mine : together) {
    asking.emplace_back([&surface, &mine] {
      for (int k = 0; k < 500; ++k) mine.push_back(surface->at(0.013 * k, 0.003 * k));
    });
  }
  testing_support::run_in_threads(asking);
  for (const auto& mine : together) {
    EXPECT_EQ(0, std::memcmp(mine.data(), alone.data(), alone.size() * sizeof(ValueGradient)));
  }
}

TEST_P(SurfaceContract, RefusesInvalidGrids) {
  const auto build = GetParam().build;
  const Eigen::MatrixXd z = Eigen::MatrixXd::Zero(3, 3);
  Eigen::MatrixXd hole = z;
  hole(1, 1) = NAN;
  EXPECT_THROW((void)build({0, 1}, {0, 1, 2}, z), std::invalid_argument);
  EXPECT_THROW((void)build({0, 2, 1}, {0, 1, 2}, z), std::invalid_argument);
  EXPECT_THROW((void)build({0, 1, INFINITY}, {0, 1, 2}, z), std::invalid_argument);
  EXPECT_THROW((void)build({0, 1, 2}, {0, 1, 2}, hole), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Methods, SurfaceContract, testing::ValuesIn(kSurfaceMethods),
                         [](const testing::TestParamInfo<SurfaceMethod>& method) {
                           return std::string(method.param.id);
                         });

}  // namespace
}  // namespace chaintrue::interp
