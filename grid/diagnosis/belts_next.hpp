// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a router on four belts should measure next so that the leading causes part: further places,
/// and places once more, chosen as next_measurements.hpp chooses points. Private to grid/diagnosis.
///
/// A place that was not measured yet gives two checks Q' y, foretold by each alternative with its
/// anchors, causes and, by kriging, its pattern (belts_pattern.hpp):
///
///   b = (X' C^-1 X + P)^-1 X' C^-1 e,   X = [A, g] of the measured checks, C = V of the pattern  (1)
///   mean = D b + K C^-1 (e - X b),   spread by D - K C^-1 X and K** - K C^-1 K'                  (2)
///
/// with D of the checks to come, K their pattern's covariance with those measured, K** their own.
///
/// Source: C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equation
/// 2.41, for (2).
#pragma once

#include "grid/diagnosis/belts_analysis.hpp"

namespace chaintrue::grid::diagnosis {

struct BeltsNext {
  /// `mark` is a command, `pulled` where the frame's orientation leaves a choice.
  std::vector<NextMeasurement> measurements;
  /// Probability that a single right explanation is left once every place is measured once more, the
  /// last one first. Empty where nothing is open, or for more places than that is computed of.
  std::optional<double> all_once_more;
  bool is_open = false;  ///< two explanations or more are left to tell apart
};
[[nodiscard]] BeltsNext next_measurements(const BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
