// SPDX-License-Identifier: GPL-3.0-or-later
// Cost against size: measures the tables of docs/reliability.md. Random points on the bed with
// usual noise; distances between random holes, each once.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/map_check.hpp"
#include "grid/random.hpp"
#include "grid/synthetic/generator.hpp"

namespace {

using namespace chaintrue;

const model::Machine kMachine{};

grid::MeasuredGrid points(std::int64_t count) {
  grid::synthetic::SyntheticSpec spec;
  spec.design.kind = grid::synthetic::DesignKind::random;
  spec.design.points = static_cast<int>(count);
  spec.noise.length_mm = 0.2;
  spec.noise.position_mm = 0.3;
  spec.draw_settings = true;
  return grid::synthetic::generate(kMachine, spec).value().grid;
}

/// Taped distances between holes cut by a true machine, with usual noise of tape and holes.
grid::MeasuredHoles distances(std::int64_t count, std::int64_t holes) {
  constexpr double kHoleMm = 0.3;
  constexpr double kTapeMm = 0.5;
  constexpr double kNearestMm = 100.0;
  grid::Random random(1, 19);
  grid::MeasuredHoles set;
  set.machine = kMachine;
  std::vector<std::pair<double, double>> places;
  for (std::int64_t i = 0; i < holes; ++i) {
    const double x_mm = random.uniform(-1150.0, 1150.0);
    const double y_mm = random.uniform(-540.0, 540.0);
    set.holes.push_back({std::to_string(i), {x_mm, y_mm}});
    places.emplace_back(x_mm + kHoleMm * random.normal(), y_mm + kHoleMm * random.normal());
  }
  // Each hole to the next, to the one after that, and so on.
  for (std::size_t step = 1; set.distances.size() < static_cast<std::size_t>(count); ++step) {
    for (std::size_t i = 0; i < places.size(); ++i) {
      const std::size_t j = (i + step) % places.size();
      const double mm =
          std::hypot(places[i].first - places[j].first, places[i].second - places[j].second);
      if (mm < kNearestMm || set.distances.size() == static_cast<std::size_t>(count)) continue;
      set.distances.push_back({.from = i, .to = j, .distance_mm = mm + kTapeMm * random.normal()});
    }
  }
  return set;
}

void fit_points(benchmark::State& state) {
  const auto grid = points(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(grid::fit(grid));
}
BENCHMARK(fit_points)
    ->Name("size/fit/points")
    ->ArgsProduct({{100, 300, 1000, 3000, 5000}})
    ->Unit(benchmark::kMillisecond);

void fit_points_of_unknown_noise(benchmark::State& state) {
  auto grid = points(state.range(0));
  grid.noise.reset();
  for (auto _ : state) benchmark::DoNotOptimize(grid::fit(grid));
}
BENCHMARK(fit_points_of_unknown_noise)
    ->Name("size/fit/points_of_unknown_noise")
    ->ArgsProduct({{100, 1000, 5000}})
    ->Unit(benchmark::kMillisecond);

void fit_distances(benchmark::State& state) {
  const auto set = distances(state.range(0), state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(grid::joint_fit(set));
}
BENCHMARK(fit_distances)
    ->Name("size/fit/distances_holes")
    ->Args({100, 20})
    ->Args({300, 30})
    ->Args({1000, 50})
    ->Args({2000, 80})
    ->Args({5000, 110})
    ->Args({5000, 150})
    ->Unit(benchmark::kMillisecond);

void check_points(benchmark::State& state) {
  const auto map = grid::fit(points(100)).value();
  const auto grid = points(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(grid::check_map(map, grid));
}
BENCHMARK(check_points)
    ->Name("size/check/points")
    ->ArgsProduct({{5, 100, 1000, 5000, 20000}})
    ->Unit(benchmark::kMillisecond);

void check_distances(benchmark::State& state) {
  const auto map = grid::fit(points(100)).value();
  const auto set = distances(state.range(0), state.range(1));
  for (auto _ : state) benchmark::DoNotOptimize(grid::check_map(map, set));
}
BENCHMARK(check_distances)
    ->Name("size/check/distances_holes")
    ->Args({100, 20})
    ->Args({1000, 50})
    ->Args({5000, 110})
    ->Args({5000, 500})
    ->Args({20000, 500})
    ->Unit(benchmark::kMillisecond);

void diagnose_points(benchmark::State& state) {
  const auto grid = points(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(grid::diagnosis::diagnose(grid));
}
BENCHMARK(diagnose_points)
    ->Name("size/diagnose/points")
    ->ArgsProduct({{100, 300, 600}})
    ->Iterations(1)
    ->Unit(benchmark::kMillisecond);

}  // namespace
