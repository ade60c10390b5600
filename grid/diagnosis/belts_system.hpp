// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Four belts as a linearised system, and their anchors and places with causes. Private to
/// grid/diagnosis.
///
/// A place leaves two checks of its four readings, a unit of two rows (observation/belt_lengths.hpp). A
/// single reading spoils one direction of them, an outlier group each; two readings of a place take
/// both. The five anchor coordinates are the settings, without priors.
///
/// With causes, the frame is fitted to corrected readings, and the causes' sizes given the frame, until
/// both converge:
///
///   e, A  rows of the readings that count, places projected out, and what anchors do to them (1 of
///         linearised_system.hpp)
///   D     what a millimetre of each reading adds to them
///   g_j   d(read)/d(size of cause j), a secant about the size at hand
///
///   min |e - A da - sum_j D g_j ds_j|^2                                                     (1)
///
/// Source: G. Golub and V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413, for unknowns that are
/// projected out.
#pragma once

#include <optional>
#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::diagnosis {

/// As effects of the belts' table.
std::vector<model::effects::ActingEffect> resolved(const std::vector<SizedCause>& causes);

/// What the causes add to the printed lengths, 4 N numbers in mm in the order of row_of(); 0 for
/// readings that such a machine cannot give.
VectorXd added_by(const MeasuredBelts& belts, const std::vector<SizedCause>& causes,
                  const belts::FrameState& state);

/// The readings minus that.
[[nodiscard]] MeasuredBelts without_effects(const MeasuredBelts& belts,
                                            const std::vector<SizedCause>& causes,
                                            const belts::FrameState& state);

/// The readings that count, by default all, about a state; units are points of which three or four
/// count. A point that the machine cannot reach there (a gross error) is linearised about the frame's
/// middle. \pre no distances.
ObservationSet observations_of(const MeasuredBelts& belts, const belts::FrameState& state,
                               double sigma_mm, const belts::Counting& counting = {});

/// Converged anchors, places and sizes; `belts` are the readings corrected for the causes.
struct FitGivenCauses : belts::Refitted {
  std::vector<SizedCause> causes;
};
/// From a nearby state; whole-number sizes are fixed, others stay in their ranges. Empty if it does
/// not converge. \pre no distances.
std::optional<FitGivenCauses> fit_given_causes(const MeasuredBelts& belts,
                                               std::vector<SizedCause> causes,
                                               const belts::AnchorFit& from);

/// What would reveal the causes that these data cannot show.
Candidates candidates(const MeasuredBelts& belts);

/// The system of readings that all count, about this state, with a regressor for each of `causes`
/// at every place where it may set in. Regressors of known causes are secants at their values.
RegressorSystem system_of(const MeasuredBelts& belts, const belts::FrameState& state,
                          const ObservationSet& session, const std::vector<CauseId>& causes = {},
                          const std::vector<SizedCause>& known = {});

/// What a cause adds to the checks of a system of these belts about this state, whitened.
VectorXd column_of(const MeasuredBelts& belts, const belts::FrameState& state,
                   const RegressorSystem& system, const SizedCause& cause);

}  // namespace chaintrue::grid::diagnosis
