// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Is what is left over as normal noise would leave it? Ordered whitened residuals against draws of
/// normal noise that went through the same fit of settings and causes.
///
/// Each set is divided by its own rms, so that the shape alone is judged; the size of the noise is
/// the noise factor's business. Deviations are measured, rank by rank and to either side, in units
/// of what 2.5 % of the draws exceed there; the largest over all ranks decides. The band is that of
/// the 95 % of draws with the smallest largest deviation (directional quantiles: M. Myllymaki et
/// al., Spatial Statistics 11 (2015) 19, section 3).
#pragma once

#include <cstdint>
#include <optional>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Of the points that were not set aside; empty where fewer than kFewestPoints are left.
[[nodiscard]] std::optional<NormalPlot> normal_plot(const Session& session,
                                                    const Analysis& analysis,
                                                    std::uint64_t seed);

}  // namespace chaintrue::grid::diagnosis
