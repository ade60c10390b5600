// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors by the one estimator (grid/estimation): belt lengths at places that nobody measured as an
/// observation, each place projected out. Private to grid/belts and what reads its fits.
///
/// Belts alone first: nothing is known of anchors beforehand, so that the noise found is (1) of
/// belts_fit.hpp, and single readings that do not fit are rejected. Then, where distances were taped,
/// once more with them, the belts' noise as it was found and the scale a parameter: a tape that
/// bends the frame must not make the belts seem less sure, and its slip not lead the search.
///
/// \code
///   const auto fit = fit_anchors_robustly(belts);
///   if (fit && fit->is_sound) use(fit->state.anchors, fit->residual_sigma_mm);
/// \endcode
#pragma once

#include <optional>
#include <tl/expected.hpp>

#include "grid/belts/anchor_fit.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/observation/belt_lengths.hpp"

namespace chaintrue::grid::belts {

/// Readings that count, and the distances; units are places of which three or four count. `about` has a
/// position of each point to linearise about, or is empty. \throws std::invalid_argument with both distances and
/// positions.
[[nodiscard]] observation::BeltLengthReadings readings_of(
    const MeasuredBelts& belts,
    const Counting& counting,
    double sigma_mm = 1.0,
    const std::vector<model::FramePoint>& about = {});

/// Four belts at a state of which nothing is known beforehand; with a scale where there are
/// distances.
[[nodiscard]] std::shared_ptr<const model::Mechanism> mechanism_at(const MeasuredBelts& belts,
                                                                   const FrameState& state);

/// A distance as these belts have it, the points where the state says; empty where a hole cannot be
/// reached.
[[nodiscard]] std::optional<observation::DistanceLine> distance_at(
    const MeasuredBelts& belts,
    const model::Mechanism& mechanism,
    const FrameState& state,
    const BeltDistance& distance);

/// Every place by its readings and distances, by all four lengths where too few count.
void place_all(const MeasuredBelts& belts,
               const observation::BeltLengthReadings& readings,
               const std::shared_ptr<const model::Mechanism>& mechanism,
               AnchorFit& fit);
/// The same about the fit's own state, with what counts and the spread as it has them.
void place_all(const MeasuredBelts& belts, AnchorFit& fit);

/// What the estimator is asked of belts alone: anchors of which nothing is known but a start, every
/// unit at full weight. `belts` without distances.
[[nodiscard]] estimation::EstimationInput anchor_input(const MeasuredBelts& belts,
                                                       const Counting& counting,
                                                       const AnchorVector& start);

/// To 1e-6 of their sigmas. Its noise_factor is the spread in mm, the first five of its covariance are
/// the anchors', mm^2.
[[nodiscard]] tl::expected<estimation::Estimate, estimation::EstimationFailure> estimate_anchors(
    const MeasuredBelts& belts, const Counting& counting, const AnchorVector& start);

/// From the likeliest start that leads to a sound frame, every reading counting; where none does the
/// one that fits best, and empty where no start leads anywhere.
[[nodiscard]] std::optional<AnchorFit> fit_anchors(const MeasuredBelts& belts);
/// The same without the readings that do not fit.
[[nodiscard]] std::optional<AnchorFit> fit_anchors_robustly(const MeasuredBelts& belts);
/// From a state near by, with what counts given.
[[nodiscard]] std::optional<AnchorFit> fit_anchors_from(const MeasuredBelts& belts,
                                                   const FrameState& state,
                                                   const Counting& counting);

}  // namespace chaintrue::grid::belts
