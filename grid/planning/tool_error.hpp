// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Derivatives of the tool's position over the bed by the unknowns of a plan. Private to
/// grid/planning.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "grid/planning/distance_choice.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid {

/// Derivative by the unknowns of the position on the sheet that is cut with the chain lengths of a
/// given position; empty if the machine has no pose there.
[[nodiscard]] std::optional<PlannedPlace> planned_place(const model::ReadingModel& model,
                                                        model::MarkPoint place);

/// Derivatives by the unknowns of a plan, kPlanUnknowns columns.
struct ToolError {
  /// L: L' L is the mean squared motion of the tool over the bed.
  Eigen::MatrixXd root;
  /// The part common to all positions: shift in x, in y (mm) and rotation (rad).
  Eigen::MatrixXd whole;
};
/// If the sheet's placement does not matter, `root` is without the common part (best placement of
/// the sheet).
[[nodiscard]] ToolError tool_error(const model::Machine& machine, bool sheet_counts);

}  // namespace chaintrue::grid
