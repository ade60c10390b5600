// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Turns an analysis of four belts into the answer. Private to grid/diagnosis.
#pragma once

#include "grid/belts/point_indices.hpp"
#include "grid/diagnosis/belts_analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// fit_with_causes() with an analysis of the same belts that is not judged yet.
[[nodiscard]] tl::expected<BeltsFit, BeltsFitFailure> fit_with_causes(
    const BeltsAnalysis& analysis);

/// Prediction of the lower belts of each half of the places by a fit to the other, including the
/// causes' sizes; empty with too few places.
std::optional<BeltPrediction> prediction_by_halves(const MeasuredBelts& belts,
                                                   const belts::AnchorFit& frame,
                                                   const std::vector<SizedCause>& causes);

/// Rejected readings (a place with more than one is listed as a whole), the unexplained pattern if the
/// decision has one, else only its probability, and `belts` without a second pass.
void take_belts_findings(const BeltsAnalysis& analysis, Diagnosis& diagnosis);

/// Measurements are proposed if they succeed with a probability of a quarter: eight that reach a
/// sixth would be wasted effort.
inline constexpr double kWorthMeasuring = 0.25;
/// A gain in probability that is worth a second session.
inline constexpr double kWorthASession = 0.05;

/// What to measure next to discriminate between the leading causes: further places and repeated
/// places, chosen as next_measurements.hpp chooses points. Each gives two checks, predicted by each
/// alternative (expected_discrimination.hpp) with its anchors, causes and pattern.
struct BeltsNext {
  /// `mark` is a command, `pulled` where the frame's orientation leaves a choice.
  std::vector<NextMeasurement> measurements;
  /// Probability that only the right explanation remains once every place is measured again, the
  /// last one first. Empty if nothing is open, or for more places than this is computed for.
  std::optional<double> all_once_more;
  /// The same with belts pulled harder, if all were measured with one pull and this reaches more
  /// than measurements at the same setting.
  std::optional<SecondPass> second_pass;
  bool is_open = false;  ///< two explanations or more remain
};
/// `indices`: positions of the points in their file.
BeltsNext next_measurements(const BeltsAnalysis& analysis, const PointIndices& indices);

/// What to measure next; last, if no tape determines the scale, the distance that would.
std::vector<NextMeasurement> measurements_of(const BeltsAnalysis& analysis, const BeltsNext& next,
                                             const PointIndices& indices);

/// verdict, sentence, what_to_do, not_proved and notes from everything else.
void put_into_words(const BeltsAnalysis& analysis, const BeltsNext& next, Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
