// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Which causes a set of readings cannot separate from one another. Private to grid/diagnosis.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/model_comparison.hpp"

namespace chaintrue::grid::diagnosis {

/// Causes that these data cannot separate, however strong; the one that gives the class its name
/// first: a cause in the machine before one on the paper. What acts by whole numbers and what acts by
/// any amount are one class where the amount that is found is such a number, the likelier first.
using CauseClass = std::vector<CauseId>;
[[nodiscard]] std::vector<CauseClass> classes_of(const RegressorSystem& system,
                                                 const ModelComparison& comparison);

}  // namespace chaintrue::grid::diagnosis
