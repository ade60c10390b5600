// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sigma of a tape's zero offset: a fit always estimates one for all distances of a file.
#pragma once

#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid {

/// One sigma of an unstated tape zero offset, mm: a hook has 1 to 2 mm of play, and from edge to
/// edge of two holes it is a bit's width, 3.2 or 6.35 mm.
inline constexpr double kAssumedTapeZeroMm = 3.0;

/// Zero if it is stated as exact.
[[nodiscard]] inline double tape_zero_sigma_mm(const Tape& tape) {
  return tape.tape_zero_offset_sigma_mm.value_or(kAssumedTapeZeroMm);
}

}  // namespace chaintrue::grid
