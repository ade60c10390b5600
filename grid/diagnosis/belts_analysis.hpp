// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the analysis of four belts does otherwise (AnalysisRules): the frame is fitted anew between comparisons,
/// nothing is stated of the noise, and something is expected to give with the pull. Private to grid/diagnosis.
#pragma once

#include <tl/expected.hpp>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/averaged_anchors.hpp"
#include "grid/diagnosis/belts_system.hpp"

namespace chaintrue::grid::diagnosis {

struct BeltsAnalysis : Analysis {
  MeasuredBelts belts;       ///< without distances: they say nothing of a cause
  belts::AnchorFit alone;    ///< anchors and places, no cause at work
  belts::AnchorFit frame;    ///< about which the system is linear, the known causes at work
  double sigma_mm = 0.0;     ///< of one belt's reading, as it is whitened
  AveragedAnchors averaged;  ///< the same for a fit and a diagnosis of the same belts
};

class BeltRules final : public AnalysisRules {
 public:
  explicit BeltRules(BeltsAnalysis& belts);
  [[nodiscard]] tl::expected<void, DiagnosisFailure> linearise(Analysis& a) const override;
  [[nodiscard]] ComparisonOptions compared(const Analysis& a, bool last) const override;
  /// The state stays where that settles nowhere.
  [[nodiscard]] bool refit(Analysis& a) const override;
  [[nodiscard]] RegressorSystem tried_with_noise(const Analysis& a) const override;
  void restrain(bool detected, Analysis& a) const override;

 private:
  BeltsAnalysis& belts_;
};

/// How far an analysis goes: to the averaged anchors, its decision that of a comparison alone; or to
/// a verdict.
enum class AnalysisDepth { anchors, verdict };

/// Precondition: fit_belts() takes these belts.
[[nodiscard]] tl::expected<BeltsAnalysis, DiagnosisFailure> analyse(
    const MeasuredBelts& belts,
    const DiagnosisOptions& options,
    AnalysisDepth depth = AnalysisDepth::verdict);

/// The frame with the readings that the decision keeps, and the causes that it holds; unless that settles
/// nowhere.
[[nodiscard]] std::optional<FitGivenCauses> fit_as_decided(const BeltsAnalysis& belts,
                                                           const Analysis& decided);

/// Of each reading, whether the decision keeps it.
[[nodiscard]] belts::Counting decided_counting(const Analysis& analysis);

/// The analysis with patterns of single belts added, for weighing laws.
[[nodiscard]] Analysis analysis_of_laws(const BeltsAnalysis& analysis);

}  // namespace chaintrue::grid::diagnosis
