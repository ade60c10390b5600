// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a diagnosis' page that try the verdict: without some of the points, for waves
/// along the chains, and whether what is left has the shape of noise.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// Which readings influence the name. Precondition: the diagnosis has a stability.
[[nodiscard]] report::Section stability_section(const grid::diagnosis::Diagnosis& found);
/// Waves in the residuals along each chain; a picture only of a chain where one stands out of
/// noise. Precondition: points that waves_can_be_sought() accepts.
[[nodiscard]] report::Section waves_section(const grid::diagnosis::Diagnosis& found);
/// Enough good points, over more than a turn of the sprocket.
[[nodiscard]] bool waves_can_be_sought(const grid::diagnosis::Diagnosis& found);
/// Folded where what is left is as normal noise. Precondition: the diagnosis has a normal plot.
[[nodiscard]] report::Section normal_section(const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::cli
