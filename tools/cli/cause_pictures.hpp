// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A picture of each cause that a diagnosis names: where the cause alone, at the size that was found,
/// puts the tool at the measured places (synthetic::signature of the machine without it). To first
/// order, as signature() is; settings are not moved to make up for it.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// In the order of the causes; without those that leave a measured place out of reach or whose
/// numbers, in a file, are no machine's. Empty of belts.
[[nodiscard]] std::vector<report::Chart> cause_charts(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
