// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of chaintrue plan that chooses holes and tape distances.
#pragma once

#include "tools/cli/sheet.hpp"

namespace chaintrue::cli {

/// The numbers of holes and distances and their sigmas, shared by all verbs that plan holes.
void require_sound(OptionProblems& problems, const HolesPlanRequest& request);

/// Adds --distances, --edges, --tape-sigma-mm and --hole-sigma-mm, for --holes.
void add_tape_options(Verb verb, HolesPlanRequest& request);

/// Writes the list, the drawing and the program; returns the exit code. \throws InputError
/// for values out of range.
int plan_the_holes(HolesPlanRequest request, const Machine& machine, const PlanOutputs& wanted);

}  // namespace chaintrue::cli
