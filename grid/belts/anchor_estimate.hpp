// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors by the estimator in grid/estimation: belt lengths at unmeasured places as an
/// observation, each place projected out. Private to grid/belts and what reads its fits.
///
/// Belts alone come first, without a prior of the anchors: the noise is (1) of belts_fit.hpp, and
/// single outliers are rejected. If distances were taped, a second fit adds them with the belts'
/// noise fixed and the scale as a parameter, so that a wrong tape neither inflates the belts' noise
/// nor misleads the search.
///
/// \code
///   const auto fit = fit_anchors_robustly(belts);
///   if (fit && fit->is_sound) use(fit->state.anchors, fit->residual_sigma_mm);
/// \endcode
#pragma once

#include <optional>
#include <vector>

#include "grid/belts/anchor_fit.hpp"
#include "grid/estimation/estimate.hpp"
#include "grid/observation/belt_lengths.hpp"

namespace chaintrue::grid::belts {

/// Where the four spans of a point come nearest to one another, from where those of the lower
/// anchors, or of the upper, cross.
FramePoint nearest_place(const BeltMachine& machine, const BeltPoint& point,
                         const PerBelt<bool>& counting);

/// Readings that count, and the distances; units are places of which three or four readings count.
/// `about` has a position of each point to linearise about, or is empty. \throws
/// std::invalid_argument with both distances and positions.
observation::BeltLengthReadings readings_of(const MeasuredBelts& belts, const Counting& counting,
                                            double sigma_mm = 1.0,
                                            const std::vector<FramePoint>& about = {});

/// Four belts at a state, without priors; with a scale if there are distances.
std::shared_ptr<const Mechanism> mechanism_at(const MeasuredBelts& belts, const FrameState& state);

/// A hole that was commanded with these anchors in force, from what the controller paid out. A command
/// that cannot be reached, or of which no anchors are known, has no lengths, and no mechanism has a
/// position for it.
observation::AtHole hole_at(const BeltMachine& in_force, BedPoint command);
/// A distance as these belts predict it, with the points of the state; empty if a hole cannot be
/// reached.
std::optional<observation::DistanceLine> distance_at(const MeasuredBelts& belts,
                                                     const Mechanism& mechanism,
                                                     const FrameState& state,
                                                     const BeltDistance& distance);

/// Every place from its readings and distances, with what counts and the spread as the fit has them; from
/// all four lengths if too few count.
void place_all(const MeasuredBelts& belts, AnchorFit& fit);

/// The estimator's input with the readings that count in a fit, about its anchors: anchors without a
/// prior, every unit at full weight. In its estimate, noise_factor is relative to the fit's spread, and
/// the first five rows of the covariance are those of the anchors, mm^2.
estimation::EstimationInput anchor_input(const MeasuredBelts& belts, const AnchorFit& from);

/// From the likeliest start that leads to a sound frame, with every reading counted; if none does,
/// the best fit; empty if no start converges.
std::optional<AnchorFit> fit_anchors(const MeasuredBelts& belts);
/// As above, without outliers.
std::optional<AnchorFit> fit_anchors_robustly(const MeasuredBelts& belts);
/// From a nearby state, with the given readings.
std::optional<AnchorFit> fit_anchors_from(const MeasuredBelts& belts, const FrameState& state,
                                          const Counting& counting);

}  // namespace chaintrue::grid::belts
