// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue simulate --belts: simulates a four-belt router that finds its anchors.
#pragma once

#include "tools/cli/simulate_options.hpp"

namespace chaintrue::cli {

/// Writes the belts file; an exit code. \throws InputError with all problems.
[[nodiscard]] int simulate_the_belts(const SimulateOptions& options);

}  // namespace chaintrue::cli
