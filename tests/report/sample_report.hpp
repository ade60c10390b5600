// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A report as a map of a 7 x 4 grid would fill it, from plain made-up data.
#pragma once

#include "tools/report/map_report.hpp"

namespace chaintrue::report::testing {

/// 28 points, one of them bad; a smooth error of some millimetres before, noise after.
[[nodiscard]] MapReport sample_report();

inline constexpr int kSamplePoints = 28;
inline constexpr int kSampleCells = 33 * 17;

}  // namespace chaintrue::report::testing
