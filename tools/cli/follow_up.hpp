// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The next measurements of a diagnosis, as a list for the workshop and as lines for the grid's
/// file; those for the holes' file are in follow_up_holes.hpp.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_grid.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Numbered sentences, each with its expected probability.
[[nodiscard]] std::string follow_up_list(const Diagnosis& found);

/// Whether any of them has this kind.
[[nodiscard]] bool proposes(const Diagnosis& found, diagnosis::MeasurementKind kind);

/// The points to add to the grid's file, with empty lengths or commands, and with visit numbers if
/// the grid has them.
[[nodiscard]] std::string points_json(const Diagnosis& found, const MeasuredGrid& measured);
[[nodiscard]] std::string points_csv(const Diagnosis& found, const MeasuredGrid& measured);
/// The readings of the machine to add to a file of either kind.
[[nodiscard]] std::string readings_json(const Diagnosis& found);

}  // namespace chaintrue::cli
