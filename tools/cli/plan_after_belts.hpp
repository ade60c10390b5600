// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan BELTS --after: what a four-belt router should measure next.
#pragma once

#include "tools/cli/plan_after.hpp"

namespace chaintrue::cli {

/// `text` is that of the belts' file. \throws InputError. Returns an exit code.
[[nodiscard]] int plan_after_belts(const PlanAfterOptions& options, const InputFile& file);

}  // namespace chaintrue::cli
