// SPDX-License-Identifier: GPL-3.0-or-later
// Poses over the classic bed, cold, in a random order; pose/wrap_only is the weightless straight
// tangent in the same run, the unit of the ratios in model/README.md.
#include <benchmark/benchmark.h>

#include <random>
#include <vector>

#include "model/chain_formulas.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::model {
namespace {

/// 4096 points of the bed, the same on every run.
std::vector<BedPoint> bench_points() {
  std::mt19937_64 engine(1);
  const auto uniform = [&engine](double half) {
    return half * (2.0 * static_cast<double>(engine() >> 11) * 0x1p-53 - 1.0);
  };
  std::vector<BedPoint> points(4096);
  for (BedPoint& p : points) p = {uniform(1219.2), uniform(609.6)};
  return points;
}

EquilibriumParameters classic(Attachment attachment = Ring{}) {
  Machine machine;
  machine.attachment = attachment;
  return equilibrium_parameters(machine);
}

void wrap_only(benchmark::State& state) {
  const std::vector<BedPoint> points = bench_points();
  const EquilibriumParameters m = classic();
  const double r = m.sprocket_radius_mm;
  for (auto _ : state) {
    for (const BedPoint& p : points) {
      benchmark::DoNotOptimize(
          straight_chain(p.x_mm - m.motors.left.x_mm, m.motors.left.y_mm - p.y_mm, r, 1.0));
      benchmark::DoNotOptimize(
          straight_chain(m.motors.right.x_mm - p.x_mm, m.motors.right.y_mm - p.y_mm, r, 1.0));
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void inverse(benchmark::State& state, Model model, Attachment attachment) {
  const std::vector<BedPoint> points = bench_points();
  const auto kinematics = make_kinematics(classic(attachment), model);
  for (auto _ : state) {
    for (const BedPoint& p : points) benchmark::DoNotOptimize(kinematics->inverse(p));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(points.size()));
}

void forward(benchmark::State& state, Attachment attachment) {
  const auto kinematics = make_kinematics(classic(attachment));
  std::vector<ChainLengths> lengths;
  for (const BedPoint& p : bench_points()) lengths.push_back(kinematics->inverse(p)->lengths);
  for (auto _ : state) {
    for (const ChainLengths& l : lengths) benchmark::DoNotOptimize(kinematics->forward(l));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(lengths.size()));
}

void jacobian(benchmark::State& state) {
  const auto kinematics = make_kinematics(classic());
  std::vector<Pose> poses;
  for (const BedPoint& p : bench_points()) poses.push_back(*kinematics->inverse(p));
  for (auto _ : state) {
    for (const Pose& pose : poses) benchmark::DoNotOptimize(kinematics->jacobian(pose));
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(poses.size()));
}

BENCHMARK(wrap_only)->Name("pose/wrap_only");
BENCHMARK_CAPTURE(inverse, elastic, Model::elastic, Ring{})->Name("pose/inverse");
BENCHMARK_CAPTURE(forward, elastic, Ring{})->Name("pose/forward");
BENCHMARK(jacobian)->Name("pose/jacobian");
BENCHMARK_CAPTURE(inverse, brackets, Model::elastic, Brackets{})->Name("pose/inverse/brackets");
BENCHMARK_CAPTURE(forward, brackets, Brackets{})->Name("pose/forward/brackets");
BENCHMARK_CAPTURE(inverse, spatial, Model::elastic_3d, Ring{})->Name("pose/inverse/elastic_3d");
BENCHMARK_CAPTURE(inverse, wrap, Model::wrap, Ring{})->Name("pose/inverse/wrap");

}  // namespace
}  // namespace chaintrue::model
