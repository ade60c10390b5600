// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The next measurements of a diagnosis, as a list for the workshop and as lines for the grid's
/// file; those for the holes' file are in follow_up_holes.hpp.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_grid.hpp"
#include "grid/observation/measured_holes.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Numbered sentences, each with its expected probability.
std::string follow_up_list(const Diagnosis& found);

/// Whether any of them has this kind.
bool proposes(const Diagnosis& found, diagnosis::MeasurementKind kind);

/// The points to add to the grid's file, with empty lengths or commands, and with visit numbers if
/// the grid has them.
std::string point_lines(const Diagnosis& found, const MeasuredGrid& measured, bool is_json);
/// The readings of the machine to add to a file of either kind.
std::string readings_json(const Diagnosis& found);

// chaintrue plan --after: the next measurements with a tape, as lines for a file of holes. If
// several sets were diagnosed together, hole A of the second is "A (2)" to the diagnosis and A in
// its own file.

/// Whether the diagnosis used exactly these holes and distances.
bool is_diagnosis_of(const Diagnosis& found, const std::vector<const MeasuredHoles*>& sets);

/// Holes to cut, with unused names, and distances without values, for the set at this position. If
/// none is in this set, JSON is empty, and a table has only its two headers.
std::string distance_lines(const Diagnosis& found, const std::vector<const MeasuredHoles*>& sets,
                           std::size_t position, bool is_json);

}  // namespace chaintrue::cli
