// SPDX-License-Identifier: GPL-3.0-or-later
// Four belts: anchors, their check and causes against the number of positions.
#include <benchmark/benchmark.h>

#include <cmath>
#include <cstdint>

#include "grid/belts/anchors_check.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/synthetic/simulated_belts.hpp"

namespace {

using namespace chaintrue;

grid::MeasuredBelts belts(int columns, int rows) {
  model::BeltMachine machine;
  machine.anchors_known = true;
  machine.anchors = {
      {-27.6, 2064.9, 100.0}, {2924.3, 2066.5, 56.0}, {0.0, 0.0, 34.0}, {2953.2, 0.0, 78.0}};
  grid::synthetic::BeltsSpec spec;
  spec.columns = columns;
  spec.rows = rows;
  spec.hidden = {{"belt_stretch", "", {{"elongation", 0.004}}}};
  return grid::synthetic::simulate_belts(machine, machine, spec).value();
}

/// As many points as a nearly square lattice has.
grid::MeasuredBelts belts(std::int64_t count) {
  const int rows = static_cast<int>(std::sqrt(static_cast<double>(count)));
  return belts(static_cast<int>(count) / rows, rows);
}

void fit_belts(benchmark::State& state) {
  const grid::MeasuredBelts measured = belts(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(grid::fit_belts(measured));
}
BENCHMARK(fit_belts)
    ->Name("size/fit/belts")
    ->ArgsProduct({{100, 1000, 5000, 20000}})
    ->Unit(benchmark::kMillisecond);

void check_belts(benchmark::State& state) {
  const grid::BeltsFit fit = grid::fit_belts(belts(100)).value();
  const grid::MeasuredBelts measured = belts(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(grid::check_anchors(fit, measured));
}
BENCHMARK(check_belts)
    ->Name("size/check/belts")
    ->ArgsProduct({{100, 1000, 5000, 20000}})
    ->Unit(benchmark::kMillisecond);

void diagnose_belts(benchmark::State& state) {
  const grid::MeasuredBelts measured = belts(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(grid::diagnosis::diagnose(measured));
}
BENCHMARK(diagnose_belts)
    ->Name("size/diagnose/belts")
    ->ArgsProduct({{100, 300, 1000, 2000}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
