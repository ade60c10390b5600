// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sets of holes for the tests of this folder.
#pragma once

#include <Eigen/QR>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "grid/files/machine_file.hpp"
#include "grid/planning/holes_plan.hpp"
#include "grid/synthetic/holes.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue::testing_support {

inline model::Machine classic() {
  return grid::files::read_machine(std::string(CHAINTRUE_FIXTURES) + "/machines/classic.json");
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

/// Root mean square over the bed of a map's error on the sheet.
inline double tool_rms_mm(const grid::CompensationMap& map,
                          const model::Machine& truth,
                          const model::SheetPlacement& sheet) {
  grid::synthetic::SyntheticAnswer answer;
  answer.machine = truth;
  answer.sheet = sheet;
  return true_tool_rms_mm(map, answer);
}

/// Root mean square over the bed of the error of a tool that pays out the lengths of `map` on the true machine, for
/// the best placement of the sheet.
inline double best_placed_rms_mm(const grid::CompensationMap& map, const model::Machine& truth) {
  constexpr int kAcross = 13;
  constexpr int kUp = 7;
  const model::ReadingModel model(truth);
  const model::Bed bed = classic().bed;
  std::vector<double> errors;
  std::vector<double> rigid;
  for (int i = 0; i < kAcross * kUp; ++i) {
    const model::BedPoint wanted{0.9 * bed.width_mm * ((i % kAcross + 0.5) / kAcross - 0.5),
                                 0.9 * bed.height_mm * ((i / kAcross + 0.5) / kUp - 0.5)};
    const auto answer = map.lengths(model::identity_placement(wanted));
    if (!answer) continue;
    const auto reading = model.find(answer->lengths, wanted);
    if (!reading) continue;
    errors.push_back(reading->pose.position.x_mm - wanted.x_mm);
    errors.push_back(reading->pose.position.y_mm - wanted.y_mm);
    rigid.insert(rigid.end(), {1.0, 0.0, -1e-3 * wanted.y_mm, 0.0, 1.0, 1e-3 * wanted.x_mm});
  }
  const auto count = static_cast<Eigen::Index>(errors.size());
  const Eigen::Map<const Eigen::VectorXd> all(errors.data(), count);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>> whole(rigid.data(), count, 3);
  const Eigen::VectorXd left = all - whole * whole.colPivHouseholderQr().solve(all);
  return std::sqrt(2.0 * left.squaredNorm() / static_cast<double>(count));
}

}  // namespace chaintrue::testing_support
