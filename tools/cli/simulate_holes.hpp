// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of chaintrue simulate that cuts holes and measures them with a tape.
#pragma once

#include "grid/planning/holes_plan.hpp"
#include "grid/synthetic/holes.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

struct HolesOptions {
  /// 0 holes: a grid is simulated instead.
  HolesPlanRequest plan{.holes = 0, .progress = {}};
  double tape_zero_offset_mm = 0.0;
  double rounding_mm = 0.0;
};

struct SimulateOptions;

/// Writes the set and, if requested, its hidden truth; returns the exit code. \throws
/// InputError for values out of range.
[[nodiscard]] int simulate_the_holes(const SimulateOptions& options, const Machine& stated);

}  // namespace chaintrue::cli
