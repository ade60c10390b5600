// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the unknowns of a plan do to the tool over the bed. Private to grid/planning.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "grid/planning/distance_choice.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid {

/// How the unknowns move, on the sheet, what is cut with the chain lengths that belong to a place;
/// nothing where the machine has no pose.
[[nodiscard]] std::optional<PlannedPlace> planned_place(const model::ReadingModel& model,
                                                        model::MarkPoint place);

/// By the unknowns of a plan, kPlanUnknowns columns.
struct ToolError {
  /// L: L' L is the mean squared motion of the tool over the bed.
  Eigen::MatrixXd root;
  /// The part of it that all places share: shift by x, by y (mm) and turn (rad).
  Eigen::MatrixXd whole;
};
/// Where the sheet's place does not count, the sheet is laid as well as it can be: `root` is
/// without the shared part.
[[nodiscard]] ToolError tool_error(const model::Machine& machine, bool sheet_counts);

}  // namespace chaintrue::grid
