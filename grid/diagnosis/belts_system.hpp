// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a diagnosis of four belts adds to their linearised system: single readings as outlier
/// groups, priors, and a regressor for each cause at every place where it may set in. Private to
/// grid/diagnosis.
///
/// A place leaves two checks of its four readings, a unit of two rows (observation/belt_lengths.hpp). A
/// single reading spoils one direction of them, an outlier group each; two readings of a place take
/// both. The five anchor coordinates are the settings, without priors.
#pragma once

#include <vector>

#include "grid/diagnosis/belts_given_causes.hpp"
#include "grid/diagnosis/regressors.hpp"

namespace chaintrue::grid::diagnosis {

/// What would reveal the causes that these data cannot show.
[[nodiscard]] Candidates candidates(const MeasuredBelts& belts);

/// The system of readings that all count, about this state, with a regressor for each of `causes`
/// at every place where it may set in. Regressors of known causes are secants at their values.
[[nodiscard]] RegressorSystem system_of(const MeasuredBelts& belts,
                                        const belts::FrameState& state,
                                        const ObservationSet& session,
                                        const std::vector<CauseId>& causes = {},
                                        const std::vector<SizedCause>& known = {});
[[nodiscard]] ObservationSet observations_of(const MeasuredBelts& belts,
                                             const belts::FrameState& state,
                                             double sigma_mm);

/// What a cause adds to the checks of a system of these belts about this state, whitened.
[[nodiscard]] Eigen::VectorXd column_of(const MeasuredBelts& belts,
                                        const belts::FrameState& state,
                                        const RegressorSystem& system,
                                        const SizedCause& cause);

}  // namespace chaintrue::grid::diagnosis
