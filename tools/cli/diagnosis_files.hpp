// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The files that a diagnosis makes besides its own.
#pragma once

#include <string>
#include <tl/expected.hpp>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::cli {

/// The grid as a fit on the extended machine wants it: marks where they are, readings without what
/// depends on the visit. An order that was only assumed is not handed on as if it were known.
[[nodiscard]] std::string corrected_grid_text(const grid::diagnosis::Diagnosis& found,
                                              grid::MeasuredGrid measured,
                                              bool order_assumed);

/// The machine with its settings calibrated and what was named in it.
[[nodiscard]] std::string extended_machine_text(const grid::diagnosis::Diagnosis& found,
                                                const std::string& source);

/// The likeliest law as a file of a declared effect, or the sentence why there is none.
[[nodiscard]] tl::expected<std::string, std::string> law_text(
    const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
