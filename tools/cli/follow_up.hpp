// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis wants measured next, as a list for the workshop and as lines for the grid's
/// file; those for the holes' file are in follow_up_holes.hpp.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::cli {

/// Numbered sentences, each with the probability that it is expected to reach.
[[nodiscard]] std::string follow_up_list(const grid::diagnosis::Diagnosis& found);

/// Whether any of it is of the kind.
[[nodiscard]] bool proposes(const grid::diagnosis::Diagnosis& found,
                            grid::diagnosis::MeasurementKind kind);

/// The points to add to the grid's file, lengths or commands left empty, with the numbers of their
/// visits where the grid numbers its visits.
[[nodiscard]] std::string points_json(const grid::diagnosis::Diagnosis& found,
                                      const grid::MeasuredGrid& measured);
[[nodiscard]] std::string points_csv(const grid::diagnosis::Diagnosis& found,
                                     const grid::MeasuredGrid& measured);
/// The readings of the machine to add to a file of either kind.
[[nodiscard]] std::string readings_json(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
