// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis wants measured next, as a list for the workshop and as lines for the grid's
/// file.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/measured_grid.hpp"

namespace chaintrue::cli {

/// Numbered sentences, each with the probability that it is expected to reach.
[[nodiscard]] std::string follow_up_list(const grid::diagnosis::Diagnosis& found);

/// The lines to add to the grid's file, values left empty: points with the numbers of their visits
/// where the grid numbers its visits, and readings, which only a JSON file holds.
[[nodiscard]] std::string follow_up_json(const grid::diagnosis::Diagnosis& found,
                                         const grid::MeasuredGrid& measured);
[[nodiscard]] std::string follow_up_csv(const grid::diagnosis::Diagnosis& found,
                                        const grid::MeasuredGrid& measured);

}  // namespace chaintrue::cli
