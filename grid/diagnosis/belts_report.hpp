// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An analysis of four belts as the answer has it. Private to grid/diagnosis.
#pragma once

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/belts_next.hpp"
#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// Anchors, places and sizes at rest with the causes that were decided on, and the readings without
/// what these add.
struct Explained {
  FitGivenCauses given;
  MeasuredBelts without_causes;
};
[[nodiscard]] Explained explained(const BeltsAnalysis& analysis);

/// Lower belts of either half of the places by a fit to the other, sizes of the causes as well; empty
/// with too few places.
[[nodiscard]] std::optional<BeltPrediction> prediction_by_halves(const MeasuredBelts& belts,
                                                                 const Explained& explained);

/// Everything but words; `alone` is what fit_belts() makes of the same belts.
[[nodiscard]] BeltsFindings belts_findings(const BeltsAnalysis& analysis,
                                           const Explained& explained,
                                           const MeasuredBelts& belts,
                                           const BeltsFit& alone);

/// The pattern that no cause makes, where the decision holds one; else its probability alone.
[[nodiscard]] Unexplained unexplained(const BeltsAnalysis& analysis);

/// Readings set aside: of a place of which more than one is, the place.
[[nodiscard]] std::vector<Outlier> bad_belts(const Explained& explained);

/// What to measure next, the distance that tells the scale last where nothing taped tells it.
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
