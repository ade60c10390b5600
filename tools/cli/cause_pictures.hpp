// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A picture of each named cause: the shift of the tool at the measured places by this cause alone,
/// at its fitted size (synthetic::signature of the machine without it). First order, as signature()
/// is; settings are not refitted.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// In the order of the causes; without those that put a measured place out of reach or, in a file,
/// have impossible numbers. Empty for belts.
[[nodiscard]] std::vector<Chart> cause_charts(const Diagnosis& found);

}  // namespace chaintrue::cli
