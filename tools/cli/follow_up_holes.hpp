// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan HOLES --after: what a diagnosis of holes wants measured next, as lines for the
/// holes' file.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/holes/measured_holes.hpp"

namespace chaintrue::cli {

/// The diagnosis is of these holes and distances.
[[nodiscard]] bool is_of_these(const grid::diagnosis::Diagnosis& found,
                               const grid::MeasuredHoles& set);
/// Holes to cut, with names that are free, and distances, their values left empty.
[[nodiscard]] std::string holes_follow_up_json(const grid::diagnosis::Diagnosis& found,
                                               const grid::MeasuredHoles& set);
[[nodiscard]] std::string holes_follow_up_csv(const grid::diagnosis::Diagnosis& found,
                                              const grid::MeasuredHoles& set);

}  // namespace chaintrue::cli
