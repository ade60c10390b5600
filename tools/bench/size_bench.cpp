// SPDX-License-Identifier: GPL-3.0-or-later
// Cost against size: measures the tables of docs/reliability.md. Random points on the bed with
// usual noise; distances between random holes, each once.
#include <cmath>
#include <string>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/map/fit.hpp"
#include "grid/map/joint_fit.hpp"
#include "grid/map/map_check.hpp"
#include "grid/random.hpp"
#include "grid/synthetic/generator.hpp"
#include "grid/synthetic/holes.hpp"
#include "tools/bench/work.hpp"

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
  constexpr double kNearestMm = 100.0;
  grid::Random random(1, 19);
  grid::MeasuredHoles set;
  set.machine = kMachine;
  for (std::int64_t i = 0; i < holes; ++i) {
    set.holes.push_back(
        {std::to_string(i), {random.uniform(-1150.0, 1150.0), random.uniform(-540.0, 540.0)}});
  }
  // Each hole to the next, to the one after that, and so on.
  const auto most = static_cast<std::size_t>(count), all = set.holes.size();
  for (std::size_t pair = 0; set.distances.size() < most; ++pair) {
    const std::size_t i = pair % all, j = (i + 1 + pair / all) % all;
    const auto &from = set.holes[i].commanded, &to = set.holes[j].commanded;
    if (std::hypot(from.x_mm - to.x_mm, from.y_mm - to.y_mm) >= kNearestMm)
      set.distances.push_back({.from = i, .to = j});
  }
  return grid::synthetic::simulate_holes(set, {}).value().set;
}

const auto fit_of_points = [](const benchmark::State& state) {
  return [grid = points(state.range(0))] { return grid::fit(grid); };
};
const auto fit_of_unknown_noise = [](const benchmark::State& state) {
  auto grid = points(state.range(0));
  grid.noise.reset();
  return [grid] { return grid::fit(grid); };
};
const auto fit_of_distances = [](const benchmark::State& state) {
  return [set = distances(state.range(0), state.range(1))] { return grid::joint_fit(set); };
};
const auto check_of_points = [](const benchmark::State& state) {
  return [map = grid::fit(points(100)).value(), grid = points(state.range(0))] {
    return grid::check_map(map, grid);
  };
};
const auto check_of_distances = [](const benchmark::State& state) {
  return [map = grid::fit(points(100)).value(), set = distances(state.range(0), state.range(1))] {
    return grid::check_map(map, set);
  };
};
const auto diagnosis_of_points = [](const benchmark::State& state) {
  return [grid = points(state.range(0))] { return grid::diagnosis::diagnose(grid); };
};

const benchmark::internal::Benchmark* const of_sizes[] = {
    bench::add("size/fit/points", fit_of_points)->ArgsProduct({{100, 300, 1000, 3000, 5000}}),
    bench::add("size/fit/points_of_unknown_noise", fit_of_unknown_noise)
        ->ArgsProduct({{100, 1000, 5000}}),
    bench::add("size/fit/distances_holes", fit_of_distances)
        ->Args({100, 20})
        ->Args({300, 30})
        ->Args({1000, 50})
        ->Args({2000, 80})
        ->Args({5000, 110})
        ->Args({5000, 150}),
    bench::add("size/check/points", check_of_points)->ArgsProduct({{5, 100, 1000, 5000, 20000}}),
    bench::add("size/check/distances_holes", check_of_distances)
        ->Args({100, 20})
        ->Args({1000, 50})
        ->Args({5000, 110})
        ->Args({5000, 500})
        ->Args({20000, 500}),
    bench::add("size/diagnose/points", diagnosis_of_points)
        ->ArgsProduct({{100, 300, 600}})
        ->Iterations(1)};

}  // namespace
