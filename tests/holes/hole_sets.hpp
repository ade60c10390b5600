// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sets of holes for the tests of this folder.
#pragma once

#include <cstdint>
#include <string>

#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/synthetic/holes.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::testing_support {

inline model::Machine classic() {
  return grid::files::read(grid::files::parse_machine,
                           std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json")
      .machine;
}

/// Nine holes and twenty distances as planned by chaintrue plan. Computed once: the search takes a
/// tenth of a second.
inline const grid::MeasuredHoles& nine_holes() {
  static const grid::MeasuredHoles set =
      grid::plan_holes(classic(), {.holes = 9, .distances = 20})->set;
  return set;
}

/// Motors, zeros and scales drawn from the stated uncertainties.
inline grid::synthetic::HolesSpec usual_holes(std::uint64_t seed) {
  grid::synthetic::HolesSpec spec;
  spec.draw_settings = true;
  spec.scale_sigma = 0.001;
  spec.seed = seed;
  return spec;
}

/// The nine holes, cut and taped.
inline grid::synthetic::SyntheticHoles cut_holes(std::uint64_t seed) {
  return grid::synthetic::simulate_holes(nine_holes(), usual_holes(seed)).value();
}

/// Root mean square over the bed of a map's error on the sheet.
inline double tool_rms_mm(const grid::CompensationMap& map, const model::Machine& truth,
                          const model::SheetPlacement& sheet) {
  grid::synthetic::SyntheticAnswer answer;
  answer.machine = truth;
  answer.sheet = sheet;
  return true_tool_rms_mm(map, answer);
}

}  // namespace chaintrue::testing_support
