// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis of four belts has of its own. Precondition of all: it is one of belts.
#pragma once

#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The frame with what its belts disagree about, before and with the causes.
[[nodiscard]] report::Section frame_section(const grid::diagnosis::Diagnosis& found);
/// The anchors before and with the causes.
[[nodiscard]] report::Section anchors_section(const grid::diagnosis::Diagnosis& found);
/// What the belts and the tool are off by, before and with the causes.
[[nodiscard]] report::Section belts_improvement_section(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] report::Light scale_light(const grid::diagnosis::Diagnosis& found);
[[nodiscard]] std::vector<report::Figure> figures_of_belts(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
