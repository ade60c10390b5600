// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Holes and distances in words and numbers, shared by several verbs.
#pragma once

#include <string>
#include <string_view>

#include "grid/map/fitted_distances.hpp"
#include "grid/planning/holes_plan.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Each distance: measured, commanded, and predicted by the others; `file` if there are several.
Section distances_section(const MeasuredHoles& set, const grid::FittedDistances& fit,
                          std::string_view file);
/// The chains' scales, and the meaning of "left out".
void add_legend(const grid::estimation::ParameterKnowledge& knowledge, Section& distances);
/// "20 distances", "18 distances and 6 to the sheet's edges".
std::string distances_in_number(const MeasuredHoles& set);
/// The holes and what to measure, as a list for the workshop.
std::string workshop_list(const grid::HolesPlan& plan);
/// What the plan's set will determine, and what it cannot distinguish.
std::string plan_in_words(const grid::HolesPlan& plan, const HolesPlanRequest& request);

}  // namespace chaintrue::cli
