// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of chaintrue plan that chooses the few points of a check.
#pragma once

#include <string>

#include "grid/map/compensation_map.hpp"
#include "grid/planning/check_plan.hpp"
#include "tools/cli/plan_outputs.hpp"

namespace chaintrue::cli {

struct CheckPlanOptions {
  /// The map to check later; empty for other plans.
  std::string map;
  grid::CheckPlanRequest request;
  /// For --measure.
  std::string measure;
};

/// Writes the list and the drawing; returns the exit code. \throws InputError for values out
/// of range.
[[nodiscard]] int plan_the_check(const CompensationMap& map,
                                 const CheckPlanOptions& options,
                                 const PlanOutputs& wanted);

}  // namespace chaintrue::cli
