// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Sections specific to a diagnosis of four belts. Precondition of all: it is one of belts.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The frame with its residuals, before and with the causes.
[[nodiscard]] Section frame_section(const Diagnosis& found);
/// The anchors before and with the causes.
[[nodiscard]] Section anchors_section(const Diagnosis& found);
/// Errors of the belts and of the tool, before and with the causes.
[[nodiscard]] Section belts_improvement_section(const Diagnosis& found);
[[nodiscard]] Light scale_light(const Diagnosis& found);
[[nodiscard]] std::vector<Figure> figures_of_belts(const Diagnosis& found);

}  // namespace chaintrue::cli
