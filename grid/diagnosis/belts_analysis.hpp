// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The rules for four belts (AnalysisRules): the frame is fitted again between comparisons,
/// the noise is not stated, and yielding under the pull is expected. Private to grid/diagnosis.
#pragma once

#include <tl/expected.hpp>

#include "grid/belts/belts_fit.hpp"
#include "grid/diagnosis/averaged_anchors.hpp"

namespace chaintrue::grid::diagnosis {

struct BeltsAnalysis : Analysis {
  MeasuredBelts measured;
  BeltsFit before;           ///< the anchors alone, by fit_belts()
  MeasuredBelts belts;       ///< without distances, which carry no information about a cause
  belts::AnchorFit alone;    ///< anchors and places without a cause
  belts::AnchorFit frame;    ///< about which the system is linear, with the known causes
  double sigma_mm = 0.0;     ///< of one belt's reading, as used for whitening
  AveragedAnchors averaged;  ///< the same for a fit and a diagnosis of the same belts
};

class BeltRules final : public AnalysisRules {
 public:
  explicit BeltRules(BeltsAnalysis& belts);
  [[nodiscard]] tl::expected<void, DiagnosisFailure> linearise(Analysis& a) const override;
  ComparisonOptions compared(const Analysis& a, bool last) const override;
  /// The state is unchanged if that does not converge.
  bool refit(Analysis& a) const override;
  [[nodiscard]] std::optional<RegressorSystem> tried_with_noise(const Analysis& a) const override;
  void restrain(bool detected, Analysis& a) const override;

 private:
  BeltsAnalysis& belts_;
};

/// To the averaged anchors, with the decision of the comparison alone; judge() makes it a verdict.
/// Fails where fit_belts() fails.
[[nodiscard]] tl::expected<BeltsAnalysis, BeltsFitFailure> analyse(const MeasuredBelts& belts,
                                                                   const DiagnosisOptions& options);

/// The frame with the readings and the causes that the decision keeps; empty if that does not
/// converge.
std::optional<FitGivenCauses> fit_as_decided(const BeltsAnalysis& belts, const Analysis& decided);

/// For each reading, whether the decision keeps it.
belts::Counting decided_counting(const Analysis& analysis);

/// The analysis with patterns of single belts added, for weighing laws.
Analysis analysis_of_laws(const BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
