// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sessions of two chains with a law that no cause has, for tests of laws.
#pragma once

#include <cmath>
#include <numbers>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "tests/diagnosis/sessions.hpp"

namespace chaintrue::grid::diagnosis::laws {

/// Readings with something more in the left chain, or with the tool moved along y.
template <class Value>
MeasuredGrid with_left(MeasuredGrid grid, Value value) {
  const model::ReadingModel machine(*grid.machine);
  for (MeasuredPoint& point : grid.points) {
    const auto reading = machine.at(model::identity_placement(point.mark)).value();
    point.lengths->left_mm += value(point.mark, reading);
  }
  return grid;
}

/// Half a turn, as a wave of the chain's length.
inline MeasuredGrid with_half_turns(std::uint64_t seed, double size_mm = 0.45,
                                    double shift_rad = 0.7, int columns = 13, int rows = 9) {
  return with_left(
      testing_support::session_of({}, seed, columns, rows), [=](const auto&, const auto& reading) {
        return size_mm *
               std::sin(2.0 * std::numbers::pi * reading.pose.lengths.left_mm / 31.75 + shift_rad);
      });
}

/// A turn whose second harmonic is as large as its first: two bumps a turn, one of them deep.
inline MeasuredGrid with_two_harmonics(std::uint64_t seed) {
  return with_left(
      testing_support::session_of({}, seed, 13, 9), [](const auto&, const auto& reading) {
        const double turn = 2.0 * std::numbers::pi * reading.pose.lengths.left_mm / 110.0;
        return 0.5 * std::sin(turn + 0.7) + 0.45 * std::sin(2.0 * turn - 0.4);
      });
}

inline MeasuredGrid with_step_along_x(std::uint64_t seed, double size_mm = 1.0) {
  return with_left(testing_support::session_of({}, seed, 9, 6),
                   [=](const model::MarkPoint& mark, const auto&) {
                     return mark.x_mm >= 250.0 ? size_mm : 0.0;
                   });
}

inline Analysis analysed(const MeasuredGrid& grid) {
  DiagnosisOptions options = testing_support::verdict_alone();
  options.stability = false;
  return testing_support::analysis_of(grid, options);
}

}  // namespace chaintrue::grid::diagnosis::laws
