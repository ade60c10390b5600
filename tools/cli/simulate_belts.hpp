// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue simulate --belts: a router on four belts finds its anchors.
#pragma once

#include "tools/cli/simulate_options.hpp"

namespace chaintrue::cli {

/// Writes the belts file; an exit code. \throws files::InputError with all that is wrong.
[[nodiscard]] int simulate_the_belts(const SimulateOptions& options);

}  // namespace chaintrue::cli
