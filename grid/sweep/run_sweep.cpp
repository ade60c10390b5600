// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/sweep/run_sweep.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "grid/containers.hpp"
#include "grid/parallel.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/raster.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::sweep {
namespace {

// The k-th cell of a share.
std::uint64_t cell_of(const Share& share, std::uint64_t k) {
  return share.index + share.count * (share.rank + share.ranks * k);
}

std::uint64_t cells_of(const Share& share, std::uint64_t cells) {
  const std::uint64_t first = cell_of(share, 0);
  return first < cells ? (cells - first - 1) / (share.count * share.ranks) + 1 : 0;
}

using synthetic::SyntheticSpec;

// Random streams of the sweep, distinct from the generator's.
constexpr std::uint64_t kSessionStream = 1U << 20U;
constexpr std::uint64_t kOtherMachineStream = 1U << 21U;

std::uint64_t seed_of(const SweepSpec& spec, std::uint64_t stream, std::uint64_t repetition) {
  Random random(spec.seed, stream + (repetition << 24U));
  return random.bits();
}

FitOptions fit_options(SurfaceLevel level) {
  FitOptions options;
  options.surface = level == SurfaceLevel::residual ? SurfaceKind::residual : SurfaceKind::direct;
  interp::EndCondition end = interp::EndCondition::not_a_knot;
  if (level == SurfaceLevel::direct_parabolic) end = interp::EndCondition::parabolic;
  if (level == SurfaceLevel::direct_natural) end = interp::EndCondition::natural;
  options.ends = {{end, end}, {end, end}};
  return options;
}

SyntheticSpec session_spec(const SweepSpec& spec, const Levels& at, std::uint64_t repetition) {
  const MachineLevel& machine = spec.machines[at[0]];
  SyntheticSpec session;
  session.design.kind = spec.spacings[at[4]];
  session.design.columns = spec.grids[at[7]].columns;
  session.design.rows = spec.grids[at[7]].rows;
  if (spec.whole_bed) session.design.margin_mm = 0.0;
  session.repeats = spec.repeats;
  session.jitter_mm = spec.jitters_mm[at[5]];
  session.noise.length_mm = spec.noises[at[6]].length_mm;
  session.noise.position_mm = spec.noises[at[6]].position_mm;
  session.hidden = spec.effects[at[1]].effects;
  session.draw_settings = spec.draw_settings;
  session.model = machine.model;
  session.unmodelled_mm = machine.unmodelled_mm;
  session.seed = seed_of(spec, kSessionStream, repetition);
  return session;
}

// The machine on which the map is used.
Machine used_machine(const SweepSpec& spec, const Levels& at, std::uint64_t repetition,
                     SyntheticSpec session) {
  const UseLevel& use = spec.uses[at[2]];
  if (use.another_of_the_build) session.seed = seed_of(spec, kOtherMachineStream, repetition);
  append_all(session.hidden, use.effects);
  return truth_of(spec.machines[at[0]].truth, session).machine;
}

CellResult hold_against_truth(const SweepSpec& spec, const Levels& at, const CompensationMap& map,
                              const Machine& machine) {
  const MachineLevel& level = spec.machines[at[0]];
  const ReadingModel truth(machine, level.model);
  // The marked part of the bed, as in the designs.
  const auto span = [&spec](double bed_mm) {
    if (spec.whole_bed) return bed_mm;
    return std::min(bed_mm, std::max(std::floor(bed_mm / 100.0), 1.0) * 100.0);
  };
  const Bed marked{span(machine.bed.width_mm), span(machine.bed.height_mm)};
  CellResult result;
  std::vector<Vector2d> chain_mm, tool_mm;
  for (const MarkPoint& mark :
       raster(area_of(marked), spec.evaluation.columns, spec.evaluation.rows, RasterOf::nodes)) {
    const BedPoint p = model::identity_placement(mark);
    const auto answer = map.lengths(mark);
    const auto real = truth.at(p);
    if (!answer || !real) {
      result.status = CellStatus::no_answer;
      continue;
    }
    const Vector2d chain = difference(answer->lengths, real->lengths) -
                           level.unmodelled_mm * vector_of(synthetic::unmodelled(p));
    chain_mm.push_back(chain);
    tool_mm.emplace_back(real->position_jacobian.inverse() * chain);
    result.chain_max_mm = std::max(result.chain_max_mm, chain.lpNorm<Eigen::Infinity>());
    result.tool_max_mm = std::max(result.tool_max_mm, tool_mm.back().norm());
  }
  result.chain_rms_mm = rms(chain_mm);
  result.tool_rms_mm = rms_length(tool_mm);
  return result;
}

}  // namespace

std::uint64_t run_sweep(const SweepSpec& spec, const CellStore& store, const SweepRun& run) {
  const std::uint64_t total = cells_of(run.share, cells(spec));
  std::uint64_t pending = 0;
  for (std::uint64_t k = 0; k < total; ++k) pending += store.has(cell_of(run.share, k)) ? 0 : 1;
  if (pending == 0) return 0;
  const KeepCell keep = store.open();
  std::mutex writing;
  std::uint64_t finished = 0;
  for_each_index(as_size(total), [&](std::uint64_t k) {
    const std::uint64_t cell = cell_of(run.share, k);
    if (store.has(cell)) return;
    const CellResult result = run_cell(spec, cell);
    const std::scoped_lock lock(writing);
    keep(cell, result);
    ++finished;
    if (run.progress) run.progress(finished, pending);
  });
  return finished;
}

CellResult run_cell(const SweepSpec& spec, std::uint64_t cell) {
  const auto repetitions = static_cast<std::uint64_t>(spec.repetitions);
  const std::uint64_t repetition = cell % repetitions;
  const Levels at = levels_of(spec, cell / repetitions);
  const SyntheticSpec made = session_spec(spec, at, repetition);
  CellResult result;
  auto session = generate(spec.machines[at[0]].truth, made);
  if (!session) {
    result.status = CellStatus::not_reached;
    return result;
  }
  session->grid.machine = spec.machines[at[0]].stated;
  const auto map = fit(session->grid, fit_options(spec.surfaces[at[3]]));
  if (!map) {
    result.status = CellStatus::no_map;
    return result;
  }
  result = hold_against_truth(spec, at, *map, used_machine(spec, at, repetition, made));
  result.expected_tool_rms_mm = map->contents().accuracy.expected_tool.rms_mm;
  return result;
}

}  // namespace chaintrue::grid::sweep
