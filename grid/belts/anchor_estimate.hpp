// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors by the one estimator (grid/estimation): belt lengths at places that nobody measured as an
/// observation, each place projected out, the noise found by restricted maximum likelihood. Private
/// to grid/belts.
///
/// Nothing is known of anchors beforehand, so that the noise found is (1) of belts_fit.hpp.
///
/// \code
///   const auto estimate = estimate_anchors(belts, counting, anchors_near_by);
///   if (estimate) use(estimate->mechanism->values(), estimate->noise_factor);
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "grid/belts/frame_solver.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/observation/belt_lengths.hpp"

namespace chaintrue::grid::belts {

/// Readings that count, with a sigma of 1 mm; units are places of which three or four count.
[[nodiscard]] observation::BeltLengthReadings readings_of(const MeasuredBelts& belts,
                                                          const Counting& counting);

/// What the estimator is asked: anchors of which nothing is known but a start, every unit at full
/// weight.
[[nodiscard]] estimation::EstimationInput anchor_input(const MeasuredBelts& belts,
                                                       const Counting& counting,
                                                       const AnchorVector& start);

/// From anchors that are some centimetres off, to 1e-6 of their sigmas. Its noise_factor is the
/// spread in mm, the first five of its covariance are the anchors', mm^2; `settled` is false where
/// 12 passes did not do.
[[nodiscard]] tl::expected<estimation::Estimate, estimation::EstimationFailure> estimate_anchors(
    const MeasuredBelts& belts, const Counting& counting, const AnchorVector& start);

}  // namespace chaintrue::grid::belts
