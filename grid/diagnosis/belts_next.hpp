// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a router on four belts should measure next so that the leading causes part: further places,
/// and places once more, chosen as next_measurements.hpp chooses points. Private to grid/diagnosis.
///
/// A place that was not measured yet gives two checks Q' y, predicted by each alternative
/// (expected_discrimination.hpp) with its anchors, causes and pattern.
#pragma once

#include "grid/belts/point_indices.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/belts_findings.hpp"

namespace chaintrue::grid::diagnosis {

/// Measurements are proposed where they reach a chance of a quarter: eight that reach a sixth are eight
/// for nothing.
inline constexpr double kWorthMeasuring = 0.25;
/// A chance of this much more is worth a second session.
inline constexpr double kWorthASession = 0.05;

struct BeltsNext {
  /// `mark` is a command, `pulled` where the frame's orientation leaves a choice.
  std::vector<NextMeasurement> measurements;
  /// Probability that a single right explanation is left once every place is measured once more, the
  /// last one first. Empty where nothing is open, or for more places than that is computed of.
  std::optional<double> all_once_more;
  /// The same with belts pulled harder, where all were measured with one pull and it reaches more than
  /// what needs no other setting of the machine.
  std::optional<SecondPass> second_pass;
  bool is_open = false;  ///< two explanations or more are left to tell apart
};
/// `indices`: where the points stand in their file.
[[nodiscard]] BeltsNext next_measurements(const BeltsAnalysis& analysis,
                                          const PointIndices& indices);

}  // namespace chaintrue::grid::diagnosis
