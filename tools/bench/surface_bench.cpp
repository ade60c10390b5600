// SPDX-License-Identifier: GPL-3.0-or-later
// Both chain surfaces of a hanging router, from the wrapped chain's closed form, on grids of
// columns by rows of nodes. Peers run on the same points in the same process.
#include <cmath>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <libalglib/interpolation.h>

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
  Samples s;
  for (int i = 0; i < nx; ++i) s.x.push_back(kBed.x_min + kBed.width() * i / (nx - 1));
  for (int j = 0; j < ny; ++j) s.y.push_back(kBed.y_min + kBed.height() * j / (ny - 1));
  s.left.resize(nx, ny);
  s.right.resize(nx, ny);
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const double x = s.x[static_cast<std::size_t>(i)];
      const double y = s.y[static_cast<std::size_t>(j)];
      s.left(i, j) = chain(x, y, -1.0);
      s.right(i, j) = chain(x, y, 1.0);
    }
  }
  return s;
}

SplinePair table(const Samples& s) {
  const auto axes = std::make_shared<const TensorAxes>(s.x, s.y);
  return SplinePair(TensorSpline(axes, s.left), TensorSpline(axes, s.right));
}

std::vector<PlanePoint> random_points(std::size_t count) {
  std::mt19937_64 random(1);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<PlanePoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back(
        {kBed.x_min + kBed.width() * uniform(), kBed.y_min + kBed.height() * uniform()});
  }
  return points;
}

void per_point(benchmark::State& state, std::size_t points) {
  state.counters["ns_per_point"] = benchmark::Counter(
      static_cast<double>(state.iterations()) * static_cast<double>(points) * 1e-9,
      benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
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

void value_gradient(benchmark::State& state,
                    const Samples& samples,
                    const std::vector<PlanePoint>& points) {
  const SplinePair surfaces = table(samples);
  std::vector<PairGradient> results(kBlock);
  for (auto _ : state) {
    for (std::size_t first = 0; first < points.size(); first += kBlock) {
      surfaces.at(std::span(points).subspan(first, kBlock), results);
      benchmark::DoNotOptimize(results.data());
      benchmark::ClobberMemory();
    }
  }
  per_point(state, points.size());
}

struct AlglibPair {
  alglib::spline2dinterpolant left, right;
};

AlglibPair alglib_pair(const Samples& s) {
  const auto nx = static_cast<alglib::ae_int_t>(s.x.size());
  const auto ny = static_cast<alglib::ae_int_t>(s.y.size());
  alglib::real_1d_array x, y, f;
  x.setcontent(nx, s.x.data());
  y.setcontent(ny, s.y.data());
  AlglibPair pair;
  f.setcontent(nx * ny, s.left.data());
  alglib::spline2dbuildbicubicv(x, nx, y, ny, f, 1, pair.left);
  f.setcontent(nx * ny, s.right.data());
  alglib::spline2dbuildbicubicv(x, nx, y, ny, f, 1, pair.right);
  return pair;
}

void alglib_value_gradient(benchmark::State& state, const Samples& samples) {
  const AlglibPair pair = alglib_pair(samples);
  const auto points = random_points(4 * kBlock);
  for (auto _ : state) {
    for (const PlanePoint& p : points) {
      double f = 0, fx = 0, fy = 0, fxy = 0;
      alglib::spline2ddiff(pair.left, p.x, p.y, f, fx, fy, fxy);
      benchmark::DoNotOptimize(f + fx + fy);
      alglib::spline2ddiff(pair.right, p.x, p.y, f, fx, fy, fxy);
      benchmark::DoNotOptimize(f + fx + fy);
    }
  }
  per_point(state, points.size());
}

double smooth(double x, double y) { return 0.8 * std::sin(x / 500 + 0.3) * std::cos(y / 400); }

// Two fields under one ridge and eight shared settings, as for a machine's two chains.
void joint_reml(benchmark::State& state, std::size_t count, bool corrected) {
  constexpr Eigen::Index kShared = 8;
  const BsplineBasis basis(kBed, 8, 4);
  const Eigen::Index m = basis.size();
  constexpr double kSigma = 0.3;
  std::mt19937_64 random(2);
  std::normal_distribution<double> noise(0.0, kSigma);
  PenalisedProblem problem(2 * m + kShared);
  problem.keeps_rows = true;
  for (const PlanePoint& p : random_points(count)) {
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, 2 * m + kShared);
    for (Eigen::Index k = 0; k < 2; ++k) {
      rows.row(k).segment(k * m, m) = basis.row(p.x, p.y).transpose() / kSigma;
      for (Eigen::Index j = 0; j < kShared; ++j) {
        const auto wave = static_cast<double>(j + k);
        rows(k, 2 * m + j) = std::sin(wave * p.x / 1500 + wave * wave * p.y / 900) / kSigma;
      }
    }
    problem.add_rows(rows,
                     Eigen::VectorXd::Constant(2, (smooth(p.x, p.y) + noise(random)) / kSigma));
  }
  problem.ridge = {0, 2 * m};
  problem.prior_precision.bottomRightCorner(kShared, kShared).setIdentity();
  FitOptions options;
  options.correct_covariance = corrected;
  for (auto _ : state) {
    benchmark::DoNotOptimize(fit_penalised(problem, options));
  }
}

const bool registered = [] {
  for (const auto& [nx, ny] :
       std::vector<std::pair<int, int>>{{7, 4}, {7, 5}, {25, 13}, {100, 50}}) {
    const Samples samples = sample(nx, ny);
    const std::string size = fmt::format("/{}x{}", nx, ny);
    const auto add = [](const std::string& name, auto function) {
      benchmark::RegisterBenchmark(name.c_str(), function);
    };
    add("surface/value_gradient" + size,
        [samples](benchmark::State& s) { value_gradient(s, samples, random_points(64 * kBlock)); });
    add("surface/value_gradient_path" + size,
        [samples](benchmark::State& s) { value_gradient(s, samples, path_points(64 * kBlock)); });
    add("surface/alglib/value_gradient" + size,
        [samples](benchmark::State& s) { alglib_value_gradient(s, samples); });
    const auto measure = [samples](auto build) {
      return [samples, build](const benchmark::State&) {
        return [samples, build] { return build(samples); };
      };
    };
    chaintrue::bench::add("surface/build" + size, measure(table), benchmark::kNanosecond);
    chaintrue::bench::add(
        "surface/alglib/build" + size, measure(alglib_pair), benchmark::kNanosecond);
  }
  for (const bool corrected : {false, true}) {
    const std::string name =
        corrected ? "surface/joint_reml_averaged/28_points" : "surface/joint_reml/28_points";
    benchmark::RegisterBenchmark(name.c_str(),
                                 [=](benchmark::State& s) { joint_reml(s, 28, corrected); });
  }
  return true;
}();

}  // namespace
