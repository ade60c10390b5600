// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A measured machine with its map, later changes, and new readings.
#pragma once

#include <functional>
#include <utility>
#include <vector>

#include "grid/map/fit.hpp"
#include "grid/map/map_check.hpp"
#include "grid/planning/check_plan.hpp"
#include "grid/random.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::testing_support {

inline constexpr double kNoiseMm = 0.3;

/// Corners and the middle of the bed.
inline const std::vector<model::MarkPoint> kFive = {
    {-1100.0, 500.0}, {1100.0, 500.0}, {0.0, 0.0}, {-1100.0, -500.0}, {1100.0, -500.0}};

struct MeasuredMachine {
  grid::CompensationMap map;
  model::Machine truth;
  std::vector<model::MarkPoint> planned;  ///< by plan_check
};

/// A map of 28 points with usual noise, and its machine.
inline MeasuredMachine measured_machine(std::uint64_t seed) {
  const auto session = grid::synthetic::generate(classic(), usual_spec(seed));
  grid::CompensationMap map = *grid::fit(session->grid);
  std::vector<model::MarkPoint> planned = grid::plan_check(map, {})->marks;
  return {std::move(map), session->answer.machine, std::move(planned)};
}

inline grid::MeasuredGrid read_at(const std::vector<model::MarkPoint>& marks,
                                  const model::Machine& machine, grid::Random& random) {
  const model::ReadingModel model(machine);
  grid::MeasuredGrid grid;
  grid.noise = grid::StatedNoise{kNoiseMm, 0.0, 15.0};
  for (const model::MarkPoint& mark : marks) {
    const auto reading = model.at(model::identity_placement(mark));
    const double left_mm = reading->lengths.left_mm + kNoiseMm * random.normal();
    const double right_mm = reading->lengths.right_mm + kNoiseMm * random.normal();
    grid.points.push_back({mark, model::ChainLengths{left_mm, right_mm}, {}, {}});
  }
  return grid;
}

/// Both chains or one grow by 0.05 %.
inline void grow(model::Machine& machine, const char* side) {
  machine.effects.push_back({"chain_pitch_error", side, {{"elongation", 0.0005}}});
}

struct MachineChange {
  const char* name;
  grid::CheckVerdict verdict;
  model::Change what;
  std::function<void(model::Machine&, grid::Random&)> happens;
};

inline const std::vector<MachineChange>& machine_changes() {
  using model::Change;
  static const std::vector<MachineChange> changes = {
      {"nothing", grid::CheckVerdict::valid, Change::nothing, [](auto&, auto&) {}},
      {"zeros shifted by up to 3 mm", grid::CheckVerdict::valid_after_rezeroing, Change::zero,
       [](model::Machine& machine, grid::Random& random) {
         machine.chain_zero.left_mm += random.uniform(-3.0, 3.0);
         machine.chain_zero.right_mm += random.uniform(-3.0, 3.0);
       }},
      {"one tooth skipped", grid::CheckVerdict::valid_after_rezeroing, Change::tooth,
       [](model::Machine& machine, grid::Random& random) {
         const double skip_mm = random.uniform() < 0.5 ? -6.35 : 6.35;
         (random.uniform() < 0.5 ? machine.chain_zero.left_mm : machine.chain_zero.right_mm) +=
             skip_mm;
       }},
      {"both chains grown", grid::CheckVerdict::measure_again, Change::pitch,
       [](model::Machine& machine, auto&) { grow(machine, "both"); }},
      {"left chain grown", grid::CheckVerdict::measure_again, Change::pitch,
       [](model::Machine& machine, auto&) { grow(machine, "left"); }},
      {"right chain grown", grid::CheckVerdict::measure_again, Change::pitch,
       [](model::Machine& machine, auto&) { grow(machine, "right"); }}};
  return changes;
}

}  // namespace chaintrue::testing_support
