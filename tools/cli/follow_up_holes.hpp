// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan --after: what a diagnosis wants measured with a tape, as lines for a file of holes.
/// Where several sets were diagnosed together, hole A of the second is "A (2)" to the diagnosis and
/// A in its own file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::cli {

/// The diagnosis is of these holes and distances and of no others.
[[nodiscard]] bool is_of_these(const grid::diagnosis::Diagnosis& found,
                               const std::vector<grid::MeasuredHoles>& sets);

/// Holes to cut, with names that are free, and distances, their values left empty, for the set at
/// this position; empty where none is of this set.
[[nodiscard]] std::string distances_json(const grid::diagnosis::Diagnosis& found,
                                         const std::vector<grid::MeasuredHoles>& sets,
                                         std::size_t position);
/// The same; the two headers where none is of this set.
[[nodiscard]] std::string distances_csv(const grid::diagnosis::Diagnosis& found,
                                        const std::vector<grid::MeasuredHoles>& sets,
                                        std::size_t position);

}  // namespace chaintrue::cli
