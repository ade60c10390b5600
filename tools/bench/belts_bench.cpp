// SPDX-License-Identifier: GPL-3.0-or-later
// Four belts: anchors, their check and causes against the number of positions.
#include <cmath>
#include <cstdint>

#include "grid/belts/anchors_check.hpp"
#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "tools/bench/work.hpp"

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
  const int rows = static_cast<int>(std::sqrt(count));
  return belts(static_cast<int>(count) / rows, rows);
}

const auto fit_of_belts = [](const benchmark::State& state) {
  return [measured = belts(state.range(0))] { return grid::fit_belts(measured); };
};
const auto check_of_belts = [](const benchmark::State& state) {
  return [fit = grid::fit_belts(belts(100)).value(), measured = belts(state.range(0))] {
    return grid::check_anchors(fit, measured);
  };
};
const auto diagnosis_of_belts = [](const benchmark::State& state) {
  return [measured = belts(state.range(0))] { return grid::diagnosis::diagnose(measured); };
};

const benchmark::internal::Benchmark* const of_belts[] = {
    bench::add("size/fit/belts", fit_of_belts)->ArgsProduct({{100, 1000, 5000, 20000}}),
    bench::add("size/check/belts", check_of_belts)->ArgsProduct({{100, 1000, 5000, 20000}}),
    bench::add("size/diagnose/belts", diagnosis_of_belts)->ArgsProduct({{100, 300, 1000, 2000}})};

}  // namespace
