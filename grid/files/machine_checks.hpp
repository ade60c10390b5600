// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Detects machines whose numbers are individually but not jointly possible: the last check of
/// every importer.
#pragma once

#include "grid/files/problems.hpp"
#include "grid/input_checks/number_checks.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Reports model::problems_of, motors that are not beyond the bed, and a place of the bed where no
/// sled can hang, or where the chains would need more pull than motors have.
void check_geometry(const Machine& machine, Problems& problems);

/// The longest chain that any place of the bed needs, from the sprocket to the sled. \pre a machine
/// without problems.
double longest_chain_mm(const Machine& machine);

/// How to give a machine that runs LinuxCNC or Klipper, where `text` is such a program's settings;
/// reports it.
void refuse_foreign_settings(std::string_view text, Problems& problems);

// The actual unit of a file whose lengths are all too small, inferred from its bed.

/// A bed of 4 to 12 feet is 48 to 144 inches wide, or 122 to 366 centimetres; the smaller of two
/// beds that are as wide in both is taken for one in inches.
inline input_checks::WrittenUnit other_unit(double bed_width) {
  constexpr double kWidestInInches = 145.0;
  return input_checks::kWrittenUnits[bed_width <= kWidestInInches ? 0 : 1];
}
/// The widest bed in centimetres, and one that remains half a metre in mm.
inline constexpr double kWidestOfOtherUnit = 370.0;

}  // namespace chaintrue::grid::files
