// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Is what is left over as normal noise would leave it? Ordered whitened residuals against draws of
/// normal noise that went through the same fit of settings and causes.
///
/// Each set is divided by its own rms, so that the shape alone is judged; the size of the noise is
/// the noise factor's business. The band is of all ranks together: it holds 95 of 100 draws whole,
/// each rank as wide as the draws scatter there to either side (global envelope scaled by
/// directional quantiles, M. Myllymaki et al., J. R. Stat. Soc. B 79 (2017) 381). The
/// chance is the draws' share that strays as far from the mean as the data do.
#pragma once

#include <cstdint>
#include <optional>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Of the points that were not set aside; empty where fewer than kFewestPoints are left.
[[nodiscard]] std::optional<NormalPlot> normal_plot(const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
