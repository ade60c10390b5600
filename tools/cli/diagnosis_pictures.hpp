// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a diagnosis that are pictures: of the tool, of the causes, of what is left.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The tool, or the distances, before and with the causes. Precondition of all: readings.
[[nodiscard]] report::Section arrows_section(const grid::diagnosis::Diagnosis& found);
/// What was measured, and what the cause and its rival make of it. Precondition: a cause is named.
[[nodiscard]] report::Section signature_section(const grid::diagnosis::Diagnosis& found);
/// Residuals against lengths, angles and visits.
[[nodiscard]] report::Section residuals_section(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
