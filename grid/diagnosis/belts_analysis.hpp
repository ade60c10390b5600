// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The steps from the lengths of four belts to a decision: anchors alone, linearise, compare models,
/// linearise anew about what was found, compare again, average the anchors. Private to grid/diagnosis.
#pragma once

#include <tl/expected.hpp>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/averaged_anchors.hpp"
#include "grid/diagnosis/belts_system.hpp"

namespace chaintrue::grid::diagnosis {

struct BeltsAnalysis {
  MeasuredBelts belts;     ///< without distances: they say nothing of a cause
  belts::AnchorFit alone;  ///< anchors and places, no cause at work
  BeltsState state;
  double sigma_mm = 0.0;     ///< of one belt's reading, as it is whitened
  AveragedAnchors averaged;  ///< the same for a fit and a diagnosis of the same belts
  Eigen::VectorXd taken_out;  ///< of the readings, as analyse_without() has it; else empty
  Analysis analysis;         ///< system, comparison and decision; its session has no parts
};

/// How far an analysis goes: to the averaged anchors, its decision that of a comparison alone; or to
/// a verdict, with the chance of noise and parts of the bed.
enum class AnalysisDepth { anchors, verdict };

/// Precondition: fit_belts() takes these belts.
[[nodiscard]] tl::expected<BeltsAnalysis, DiagnosisFailure> analyse(
    const MeasuredBelts& belts,
    const DiagnosisOptions& options,
    AnalysisDepth depth = AnalysisDepth::verdict);

/// Of each reading, whether the decision keeps it.
[[nodiscard]] belts::Counting decided_counting(const BeltsAnalysis& analysis);

/// The analysis as laws are weighed in it: next to patterns of single belts as well.
[[nodiscard]] Analysis analysis_of_laws(const BeltsAnalysis& analysis);

/// As analyse_without() of two chains (analysis.hpp).
[[nodiscard]] BeltsAnalysis analyse_without(BeltsAnalysis analysis, Eigen::VectorXd rows);

/// The causes of the decision with their values as estimated.
[[nodiscard]] std::vector<BeltCause> decided_causes(const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
