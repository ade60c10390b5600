// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The additional files of a diagnosis.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_grid.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// The grid for a fit on the extended machine: true positions of marks, readings without effects of
/// the visit. An assumed order is not written.
[[nodiscard]] std::string corrected_grid_text(const Diagnosis& found,
                                              MeasuredGrid measured,
                                              bool order_assumed);

/// The calibrated machine with the named causes.
[[nodiscard]] std::string extended_machine_text(const Diagnosis& found, const std::string& source);

/// The likeliest law as a file of a declared effect, or a sentence that explains why there is none.
[[nodiscard]] tl::expected<std::string, std::string> law_text(const Diagnosis& found);

}  // namespace chaintrue::cli
