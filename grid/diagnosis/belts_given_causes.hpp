// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors and places of a four-belt router with causes: the frame is fitted to corrected readings,
/// and the causes' sizes given the frame, until both converge. Private to grid/diagnosis.
///
/// Notation
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

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/belts/fit_diagnostics.hpp"
#include "grid/diagnosis/regressor_system.hpp"
#include "model/belts/belt_readings.hpp"

namespace chaintrue::grid::diagnosis {

/// As effects of the belts' table.
[[nodiscard]] std::vector<model::effects::ActingEffect> resolved(
    const std::vector<SizedCause>& causes);

/// What the causes add to the printed lengths, 4 N numbers in mm in the order of row_of(); 0 for
/// readings that such a machine cannot give.
[[nodiscard]] Eigen::VectorXd added_by(const MeasuredBelts& belts,
                                       const std::vector<SizedCause>& causes,
                                       const belts::FrameState& state);

/// The readings minus that.
[[nodiscard]] MeasuredBelts without_effects(const MeasuredBelts& belts,
                                            const std::vector<SizedCause>& causes,
                                            const belts::FrameState& state);

/// The readings that count, about a state; units are points of which three or four count. A point
/// that the machine cannot reach there (a gross error) is linearised about the frame's middle.
[[nodiscard]] ObservationSet observations_of(const MeasuredBelts& belts,
                                             const belts::FrameState& state,
                                             const belts::Counting& counting,
                                             double sigma_mm);

/// Converged anchors, places and sizes.
struct FitGivenCauses {
  belts::AnchorFit frame;
  std::vector<SizedCause> causes;
  MeasuredBelts without_causes;  ///< readings corrected for the causes; no distances
};
/// From a nearby state; whole-number sizes are fixed, others stay in their ranges. Empty if it does
/// not converge.
[[nodiscard]] std::optional<FitGivenCauses> fit_given_causes(const MeasuredBelts& belts,
                                                       std::vector<SizedCause> causes,
                                                       const belts::AnchorFit& from);

}  // namespace chaintrue::grid::diagnosis
