// SPDX-License-Identifier: GPL-3.0-or-later
// Both chain surfaces of a hanging router, from the wrapped chain's closed form, on grids of
// columns by rows of nodes. Peers run on the same points in the same process; items are points.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <libalglib/interpolation.h>

#include "grid/random.hpp"
#include "interp/bspline_basis.hpp"
#include "interp/reml.hpp"
#include "interp/spline_pair.hpp"
#include "interp/tensor_spline.hpp"
#include "tools/bench/work.hpp"

namespace {

using namespace chaintrue::interp;

constexpr Rectangle kBed = {-1219.2, 1219.2, -609.6, 609.6};
constexpr std::size_t kBlock = 1024;

// Chain over the top of a sprocket of radius r at (side * 1500, 1060), from its 12 o'clock.
double chain(double x, double y, double side) {
  constexpr double kRadius = 10.1;
  const double dx = 1500.0 - side * x;
  const double dy = 1060.0 - y;
  const double d = std::sqrt(dx * dx + dy * dy);
  const double wrap = std::atan2(dy, dx) + std::asin(kRadius / d);
  return std::sqrt(d * d - kRadius * kRadius) + kRadius * wrap;
}

struct Samples {
  std::vector<double> x, y;
  Eigen::MatrixXd left, right;
};

Samples sample(int nx, int ny) {
  const auto nodes = [](int count, double from, double to) {
    const Eigen::VectorXd places = Eigen::VectorXd::LinSpaced(count, from, to);
    return std::vector<double>(places.begin(), places.end());
  };
  Samples s{nodes(nx, kBed.x_min, kBed.x_max), nodes(ny, kBed.y_min, kBed.y_max)};
  const auto surface = [&](double side) -> Eigen::MatrixXd {
    return Eigen::MatrixXd::NullaryExpr(nx, ny, [&](Eigen::Index i, Eigen::Index j) {
      return chain(s.x[static_cast<std::size_t>(i)], s.y[static_cast<std::size_t>(j)], side);
    });
  };
  s.left = surface(-1.0);
  s.right = surface(1.0);
  return s;
}

SplinePair table(const Samples& s) {
  const auto axes = std::make_shared<const TensorAxes>(s.x, s.y);
  return SplinePair(TensorSpline(axes, s.left), TensorSpline(axes, s.right));
}

std::vector<PlanePoint> random_points(std::size_t count) {
  chaintrue::grid::Random random(1);
  std::vector<PlanePoint> points(count);
  for (PlanePoint& p : points)
    p = {random.uniform(kBed.x_min, kBed.x_max), random.uniform(kBed.y_min, kBed.y_max)};
  return points;
}

// A serpentine over the whole bed in steps of 0.5 mm, as a tool moves.
std::vector<PlanePoint> path_points(std::size_t count) {
  std::vector<PlanePoint> points;
  double x = kBed.x_min;
  double y = kBed.y_min;
  double step = 0.5;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back({x, y});
    x += step;
    if (x > kBed.x_max || x < kBed.x_min) {
      step = -step;
      x += step;
      y += 87.0;
    }
  }
  return points;
}

constexpr std::size_t kPoints = 64 * kBlock;

auto value_gradient(const Samples& samples, std::vector<PlanePoint> (*points_of)(std::size_t)) {
  return [=](const benchmark::State&) {
    return [surfaces = table(samples), points = points_of(kPoints),
            results = std::vector<PairGradient>(kBlock)]() mutable {
      for (std::size_t k = 0; k < points.size(); ++k) {
        results[k % kBlock] = surfaces.at(points[k].x, points[k].y);
        benchmark::ClobberMemory();
      }
      return results.data();
    };
  };
}

struct AlglibPair {
  alglib::spline2dinterpolant left, right;
};

AlglibPair alglib_pair(const Samples& s) {
  const auto nx = static_cast<alglib::ae_int_t>(s.x.size());
  const auto ny = static_cast<alglib::ae_int_t>(s.y.size());
  alglib::real_1d_array x, y;
  x.setcontent(nx, s.x.data());
  y.setcontent(ny, s.y.data());
  const auto surface = [&](const Eigen::MatrixXd& values) {
    alglib::real_1d_array f;
    f.setcontent(nx * ny, values.data());
    alglib::spline2dinterpolant built;
    alglib::spline2dbuildbicubicv(x, nx, y, ny, f, 1, built);
    return built;
  };
  return {surface(s.left), surface(s.right)};
}

auto alglib_value_gradient(const Samples& samples) {
  return [=](const benchmark::State&) {
    return [pair = alglib_pair(samples), points = random_points(kPoints)] {
      for (const PlanePoint& p : points) {
        for (const auto* surface : {&pair.left, &pair.right}) {
          double f = 0, fx = 0, fy = 0, fxy = 0;
          alglib::spline2ddiff(*surface, p.x, p.y, f, fx, fy, fxy);
          benchmark::DoNotOptimize(f + fx + fy);
        }
      }
      return points.data();
    };
  };
}

double smooth(double x, double y) { return 0.8 * std::sin(x / 500 + 0.3) * std::cos(y / 400); }

// Two fields under one ridge and eight shared settings, as for a machine's two chains.
PenalisedProblem joint_problem(std::size_t count) {
  constexpr Eigen::Index kShared = 8;
  const BsplineBasis basis(kBed, 8, 4);
  const Eigen::Index m = basis.size();
  constexpr double kSigma = 0.3;
  chaintrue::grid::Random random(2);
  PenalisedProblem problem(kShared + 2 * m);
  for (const PlanePoint& p : random_points(count)) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, kShared + 2 * m);
    for (Eigen::Index k = 0; k < 2; ++k) {
      rows.row(k).segment(kShared + k * m, m) = basis.row(p.x, p.y).transpose() / kSigma;
      for (Eigen::Index j = 0; j < kShared; ++j) {
        const auto wave = static_cast<double>(j + k);
        rows(k, j) = std::sin(wave * p.x / 1500 + wave * wave * p.y / 900) / kSigma;
      }
    }
    problem.add_rows(rows,
                     Eigen::VectorXd::Constant(2, smooth(p.x, p.y) / kSigma + random.normal()));
  }
  problem.ridge = {2 * m, problem.design.rightCols(2 * m).colwise().squaredNorm().mean()};
  problem.prior_precision.topLeftCorner(kShared, kShared).setIdentity();
  return problem;
}

const bool registered = [] {
  using chaintrue::bench::add;
  for (const auto& [nx, ny] :
       std::vector<std::pair<int, int>>{{7, 4}, {7, 5}, {25, 13}, {100, 50}}) {
    const Samples samples = sample(nx, ny);
    const std::string size = fmt::format("/{}x{}", nx, ny);
    const auto add_points = [&](const std::string& name, const auto& prepare) {
      add("surface/" + name + size, prepare, benchmark::kMicrosecond, kPoints);
    };
    add_points("value_gradient", value_gradient(samples, random_points));
    add_points("value_gradient_path", value_gradient(samples, path_points));
    add_points("alglib/value_gradient", alglib_value_gradient(samples));
    const auto measure = [samples](auto build) {
      return [samples, build](const benchmark::State&) {
        return [samples, build] { return build(samples); };
      };
    };
    add("surface/build" + size, measure(table), benchmark::kNanosecond);
    add("surface/alglib/build" + size, measure(alglib_pair), benchmark::kNanosecond);
  }
  for (const bool corrected : {false, true}) {
    add(
        corrected ? "surface/joint_reml_averaged/28_points" : "surface/joint_reml/28_points",
        [corrected](const benchmark::State&) {
          FitOptions options;
          options.correct_covariance = corrected;
          return [options, problem = joint_problem(28)] { return fit_penalised(problem, options); };
        },
        benchmark::kNanosecond);
  }
  return true;
}();

}  // namespace
