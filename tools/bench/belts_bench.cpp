// SPDX-License-Identifier: GPL-3.0-or-later
// Four belts: anchors and causes from 100 and 1,000 places.
#include <benchmark/benchmark.h>

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

void fit_belts(benchmark::State& state, int columns, int rows) {
  const grid::MeasuredBelts measured = belts(columns, rows);
  for (auto _ : state) benchmark::DoNotOptimize(grid::fit_belts(measured));
}
BENCHMARK_CAPTURE(fit_belts, 100_places, 10, 10)
    ->Name("fit/belts/100_places")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(fit_belts, 1000_places, 40, 25)
    ->Name("fit/belts/1000_places")
    ->Unit(benchmark::kMillisecond);

void diagnose_belts(benchmark::State& state, int columns, int rows) {
  const grid::MeasuredBelts measured = belts(columns, rows);
  for (auto _ : state) benchmark::DoNotOptimize(grid::diagnosis::diagnose(measured));
}
BENCHMARK_CAPTURE(diagnose_belts, 100_places, 10, 10)
    ->Name("diagnose/belts/100_places")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(diagnose_belts, 1000_places, 40, 25)
    ->Name("diagnose/belts/1000_places")
    ->Unit(benchmark::kMillisecond);

}  // namespace
