// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The pictures of a diagnosis whose readings are distances between holes: one line for each
/// distance, vermilion if read longer than predicted, blue if shorter, with a width proportional to
/// the residual.
#pragma once

#include "grid/diagnosis/diagnosis.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// The calibrated machine next to the machine with the named causes.
[[nodiscard]] Chart distance_chart(const Diagnosis& found);
/// Measured, best cause, rival, remainder. Precondition: a cause is named.
[[nodiscard]] Chart distance_strip_chart(const Diagnosis& found);
/// Residuals against the distance's length, and against the way it was measured.
[[nodiscard]] ChartRow distance_scatter_charts(const Diagnosis& found);
/// What was measured, in grey, and what to measure next.
[[nodiscard]] Chart next_distances_chart(const Diagnosis& found);

}  // namespace chaintrue::cli
