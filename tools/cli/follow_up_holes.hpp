// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan --after: the next measurements with a tape, as lines for a file of holes. If
/// several sets were diagnosed together, hole A of the second is "A (2)" to the diagnosis and A in
/// its own file.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_holes.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Whether the diagnosis used exactly these holes and distances.
[[nodiscard]] bool is_diagnosis_of(const Diagnosis& found, const std::vector<MeasuredHoles>& sets);

/// Holes to cut, with unused names, and distances without values, for the set at this position;
/// empty if none is in this set.
[[nodiscard]] std::string distances_json(const Diagnosis& found,
                                         const std::vector<MeasuredHoles>& sets,
                                         std::size_t position);
/// As above; only the two headers if none is in this set.
[[nodiscard]] std::string distances_csv(const Diagnosis& found,
                                        const std::vector<MeasuredHoles>& sets,
                                        std::size_t position);

}  // namespace chaintrue::cli
