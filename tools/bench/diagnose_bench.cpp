// SPDX-License-Identifier: GPL-3.0-or-later
// A whole diagnosis: comparison, held-out gain with the naming repeated in each fold, next
// measurements.
#include <benchmark/benchmark.h>

#include "grid/diagnosis/diagnose.hpp"
#include "grid/synthetic/generator.hpp"

namespace {

using namespace chaintrue;

void diagnose_points(benchmark::State& state, int columns, int rows) {
  grid::synthetic::SyntheticSpec spec;
  spec.design.columns = columns;
  spec.design.rows = rows;
  spec.order = grid::synthetic::VisitingOrder::random;
  spec.repeats = 6;
  spec.noise.length_mm = 0.2;
  spec.noise.position_mm = 0.3;
  spec.stated = grid::StatedNoise{0.2, 0.3, 12.0};
  spec.draw_settings = true;
  spec.hidden = {{"chain_pitch_error", "left", {{"elongation", 0.001}}}};
  const auto grid = grid::synthetic::generate(model::Machine{}, spec).value().grid;
  for (auto _ : state) benchmark::DoNotOptimize(grid::diagnosis::diagnose(grid));
}
BENCHMARK_CAPTURE(diagnose_points, 28_points, 7, 4)
    ->Name("diagnose/28_points")
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(diagnose_points, 200_points, 20, 10)
    ->Name("diagnose/200_points")
    ->Unit(benchmark::kMillisecond);

}  // namespace
