// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a router on four belts should measure next so that the leading causes part: further places,
/// and places once more, chosen as next_measurements.hpp chooses points. Private to grid/diagnosis.
///
/// A place that was not measured yet gives two checks Q' y, predicted by each alternative
/// (expected_discrimination.hpp) with its anchors, causes and pattern.
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
