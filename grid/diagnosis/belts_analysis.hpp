// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The steps from the lengths of four belts to a decision: anchors alone, linearise, compare models,
/// linearise anew about what was found, compare again. Private to grid/diagnosis.
#pragma once

#include <tl/expected.hpp>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/belts_system.hpp"

namespace chaintrue::grid::diagnosis {

struct BeltsAnalysis {
  MeasuredBelts belts;        ///< without distances: they say nothing of a cause
  belts::AnchorFit alone;     ///< anchors and places, no cause at work
  BeltsState state;
  double sigma_mm = 0.0;  ///< of one belt's reading, as it is whitened
  Analysis analysis;      ///< system, comparison and decision; its session has no parts
};

/// Precondition: fit_belts() takes these belts.
[[nodiscard]] tl::expected<BeltsAnalysis, DiagnosisFailure> analyse(const MeasuredBelts& belts,
                                                                    const DiagnosisOptions& options);

/// Of each reading, whether the decision keeps it.
[[nodiscard]] belts::Counting decided_counting(const BeltsAnalysis& analysis);

/// The causes of the decision with their values as estimated.
[[nodiscard]] std::vector<BeltCause> decided_causes(const Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
