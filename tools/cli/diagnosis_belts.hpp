// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sections specific to a diagnosis of four belts. Precondition of all: it is one of belts.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The frame with its residuals, before and with the causes.
[[nodiscard]] report::Section frame_section(const grid::diagnosis::Diagnosis& found);
/// The anchors before and with the causes.
[[nodiscard]] report::Section anchors_section(const grid::diagnosis::Diagnosis& found);
/// Errors of the belts and of the tool, before and with the causes.
[[nodiscard]] report::Section belts_improvement_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Light scale_light(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] std::vector<report::Figure> figures_of_belts(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
