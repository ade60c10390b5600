// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compares a map on a machine with causes with the plain one at points in blocks of the bed
/// to which neither was fitted: (1) of causes_fit.hpp. Private to grid/diagnosis.
#pragma once

#include <cstddef>
#include <vector>

#include "grid/diagnosis/causes_fit.hpp"

namespace chaintrue::grid::diagnosis {

/// Squared error of the tool at what one map left out, mm^2, and the block it was left out with.
struct HeldOutSquare {
  double plain_mm2 = 0.0;
  double with_causes_mm2 = 0.0;
  std::size_t block = 0;
};

/// Points that the map with causes keeps, and distances where there are no points. Points that it
/// rejects are bad in any case; points that only the plain map rejects count, since the causes
/// explain them.
[[nodiscard]] std::vector<HeldOutSquare> held_out_squares(const JointFit& plain,
                                                          const JointFit& with_causes);

[[nodiscard]] HeldOutBlocksError error_of(const std::vector<HeldOutSquare>& squares);

/// D of (1) exceeds its standard error.
[[nodiscard]] bool falls_beyond_its_error(const std::vector<HeldOutSquare>& squares);

}  // namespace chaintrue::grid::diagnosis
