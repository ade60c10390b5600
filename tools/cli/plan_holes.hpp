// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of chaintrue plan that chooses holes and tape distances.
#pragma once

#include <string>

#include "grid/planning/holes_plan.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/plan_outputs.hpp"

namespace chaintrue::cli {

struct HolesPlanOptions {
  /// 0 holes: points are planned instead.
  grid::HolesPlanRequest request{.holes = 0, .progress = {}};
};

/// The numbers of holes and distances and their sigmas, shared by all verbs that plan holes.
void require_sound(OptionProblems& problems, const grid::HolesPlanRequest& request);

void add_plan_holes_options(Verb verb, HolesPlanOptions& options, Option points);

/// Writes the list, the drawing and the program; returns the exit code. \throws files::InputError
/// for values out of range.
[[nodiscard]] int plan_the_holes(const HolesPlanOptions& options,
                                 const model::Machine& machine,
                                 const PlanOutputs& wanted);

}  // namespace chaintrue::cli
