// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Turns an analysis of four belts into the answer. Private to grid/diagnosis.
#pragma once

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/point_indices.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// Anchors, places and sizes at rest with the causes that were decided on.
[[nodiscard]] FitGivenCauses explained(const BeltsAnalysis& analysis);

/// Prediction of the lower belts of each half of the places by a fit to the other, including the
/// causes' sizes; empty with too few places.
[[nodiscard]] std::optional<BeltPrediction> prediction_by_halves(const MeasuredBelts& belts,
                                                                 const FitGivenCauses& given);

/// Everything but words; `alone` is what fit_belts() makes of the same belts.
[[nodiscard]] BeltsFindings belts_findings(const BeltsAnalysis& analysis,
                                           const FitGivenCauses& given,
                                           const MeasuredBelts& belts,
                                           const BeltsFit& alone);

/// The unexplained pattern if the decision has one; else only its probability.
[[nodiscard]] Unexplained unexplained(const BeltsAnalysis& analysis);

/// Readings set aside: of a place of which more than one is, the place.
[[nodiscard]] std::vector<Outlier> bad_belts(const FitGivenCauses& given);

/// Measurements are proposed where they reach a chance of a quarter: eight that reach a sixth are eight
/// for nothing.
inline constexpr double kWorthMeasuring = 0.25;
/// A chance of this much more is worth a second session.
inline constexpr double kWorthASession = 0.05;

/// What to measure next so that the leading causes part: further places, and places once more, chosen as
/// next_measurements.hpp chooses points. Each gives two checks, predicted by each alternative
/// (expected_discrimination.hpp) with its anchors, causes and pattern.
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

/// What to measure next; last, if no tape determines the scale, the distance that would.
[[nodiscard]] std::vector<NextMeasurement> measurements_of(const BeltsNext& next,
                                                           const MeasuredBelts& belts,
                                                           const BeltsFit& alone,
                                                           const Decision& decision,
                                                           const PointIndices& indices);

/// verdict, sentence, what_to_do, not_proved and notes from everything else.
void put_belts_into_words(const MeasuredBelts& belts,
                          const BeltsFit& alone,
                          const BeltsNext& next,
                          Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
