// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A measurement plan as a drawing: the bed coloured by the expected error, the marks numbered in
/// the order of the walk. Same plan, same bytes.
#pragma once

#include <string>
#include <vector>

#include "grid/planning/holes_plan.hpp"
#include "grid/planning/measurement_plan.hpp"
#include "tools/cli/diagnosis_words.hpp"

namespace chaintrue::cli {

/// Over the bed, cell by cell from the bottom left.
struct ExpectedErrors {
  int columns = 0;
  int rows = 0;
  std::vector<double> cells_mm;  ///< negative if the map has no answer
  double rms_mm = 0.0;
  double largest_mm = 0.0;
  MarkPoint worst_at;
  std::size_t unanswered = 0;
};
ExpectedErrors expected_errors(const CompensationMap& map, const Bed& bed);

/// A self-contained SVG; nothing is fetched, no script runs.
std::string draw_plan(const grid::MeasurementPlan& plan, const Bed& bed,
                      const ExpectedErrors& errors);

/// The next places as numbered crosses among the measured ones.
std::string draw_follow_up(const std::vector<MarkPoint>& measured,
                           const std::vector<FollowUpPlace>& next, const Bed& bed);

// A plan of holes as a drawing: the sheet, the holes by name, a line for each distance to measure.
// Same plan, same bytes.

/// The foot of the perpendicular on an edge of the bed.
BedPoint on_edge(BedPoint from, grid::SheetEdge edge, const Bed& bed);
/// A self-contained SVG; nothing is fetched, no script runs.
std::string draw_holes_plan(const grid::HolesPlan& plan);

}  // namespace chaintrue::cli
