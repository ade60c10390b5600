// SPDX-License-Identifier: GPL-3.0-or-later
// The whole fit and the map's queries. 28 points are a usual grid, 91 a large one.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/map/query_points.hpp"
#include "grid/synthetic/generator.hpp"

namespace {

using namespace chaintrue;

grid::MeasuredGrid grid_of(int columns, int rows) {
  grid::synthetic::SyntheticSpec spec;
  spec.design.columns = columns;
  spec.design.rows = rows;
  spec.jitter_mm = 8.0;
  spec.noise.length_mm = 0.2;
  spec.noise.position_mm = 0.3;
  spec.draw_settings = true;
  return grid::synthetic::generate(model::Machine{}, spec).value().grid;
}

void fit_points(benchmark::State& state, int columns, int rows) {
  const grid::MeasuredGrid grid = grid_of(columns, rows);
  for (auto _ : state) benchmark::DoNotOptimize(grid::fit(grid));
}
BENCHMARK_CAPTURE(fit_points, 28_points, 7, 4)
    ->Name("map/fit/28_points")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_points, 91_points, 13, 7)
    ->Name("map/fit/91_points")
    ->Unit(benchmark::kMillisecond);

void query_lengths(benchmark::State& state) {
  const auto map = grid::fit(grid_of(7, 4)).value();
  double x = -1000.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(map.lengths({x, 0.25 * x}));
    x = x < 1000.0 ? x + 1.0 : -1000.0;
  }
}
BENCHMARK(query_lengths)->Name("map/lengths");

void query_with_sigma(benchmark::State& state) {
  const auto map = grid::fit(grid_of(7, 4)).value();
  double x = -1000.0;
  for (auto _ : state) {
    benchmark::DoNotOptimize(map.query({x, 0.25 * x}));
    x = x < 1000.0 ? x + 1.0 : -1000.0;
  }
}
BENCHMARK(query_with_sigma)->Name("map/query");

/// A thousand places at once, as in compensating or drawing a program.
std::vector<model::MarkPoint> thousand_places() {
  std::vector<model::MarkPoint> places;
  for (int i = 0; i < 1000; ++i) places.push_back({2.0 * i - 1000.0, 0.5 * i - 250.0});
  return places;
}

void query_many(benchmark::State& state) {
  const auto map = grid::fit(grid_of(7, 4)).value();
  const auto places = thousand_places();
  std::vector<grid::MapAnswerOrFailure> answers(places.size());
  for (auto _ : state) {
    grid::query(map, places, answers);
    benchmark::DoNotOptimize(answers.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}
BENCHMARK(query_many)->Name("map/query/1000_places")->Unit(benchmark::kMillisecond);

void lengths_of_many(benchmark::State& state) {
  const auto map = grid::fit(grid_of(7, 4)).value();
  const auto places = thousand_places();
  std::vector<grid::MapLengthsOrFailure> answers(places.size());
  for (auto _ : state) {
    grid::lengths(map, places, answers);
    benchmark::DoNotOptimize(answers.data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(places.size()));
}
BENCHMARK(lengths_of_many)->Name("map/lengths/1000_places")->Unit(benchmark::kMillisecond);

}  // namespace
