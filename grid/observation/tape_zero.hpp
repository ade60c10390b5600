// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How well a tape's zero offset is known: a fit estimates one for all distances of a file always.
#pragma once

#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid {

/// One sigma of a tape's zero offset that nobody stated, mm: a hook has 1 to 2 mm of play, and from
/// edge to edge of two holes it is a bit's width, 3.2 or 6.35 mm.
inline constexpr double kAssumedTapeZeroMm = 3.0;

/// Zero where somebody states that it is known exactly.
[[nodiscard]] inline double tape_zero_sigma_mm(const Tape& tape) {
  return tape.tape_zero_offset_sigma_mm.value_or(kAssumedTapeZeroMm);
}

}  // namespace chaintrue::grid
