// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of chaintrue simulate that cuts holes and measures them with a tape.
#pragma once

#include <string>

#include "grid/synthetic/holes.hpp"

namespace chaintrue::cli {

struct HolesOptions {
  int holes = 0;
  int distances = 0;
  bool edges = false;
  double tape_sigma_mm = 0.5;
  double hole_sigma_mm = 0.3;
  double hook_offset_mm = 0.0;
  double rounding_mm = 0.0;
};

/// Writes the set and returns the exit code. \throws files::InputError for values out of range.
[[nodiscard]] int simulate_the_holes(const HolesOptions& options,
                                     const model::Machine& stated,
                                     const model::Machine& truth,
                                     const grid::synthetic::HolesSpec& spec,
                                     const std::string& output);

}  // namespace chaintrue::cli
