// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The section on the verdict without some of the readings.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Which readings influence the name. Precondition: the diagnosis has a stability.
[[nodiscard]] Section stability_section(const Diagnosis& found);

}  // namespace chaintrue::cli
