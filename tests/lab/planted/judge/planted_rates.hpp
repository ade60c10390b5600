// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Outcomes of draws from real scans, their facts, and the table of rates.
///
/// A draw has two outcomes (sealed/judge/outcome.hpp), of kind SCAN:plain for the readings as they are and
/// SCAN:planted for those with the cause added. In place of names they hold every class with its
/// probability (claims.hpp). A claim is
///
///   denied     if its class is below 50 % in the diagnosis of the whole scan
///   borne out  if its class is above 90 % there
///
/// The reference of a whole scan is frozen, so that a diagnosis gains nothing by silence about it.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "planted/judge/scan.hpp"
#include "sealed/judge/calibration.hpp"
#include "sealed/judge/rates.hpp"

namespace chaintrue::planted {

using sealed::Outcome;

/// Plain and planted.
[[nodiscard]] std::pair<Outcome, Outcome> run_draw(const Scan& scan,
                                                   const std::vector<Reference>& references,
                                                   std::uint64_t seed);

/// Sets the facts that follow from the claims, besides `order` and `named` (outright, alone or with
/// others): none_denied_90 and none_denied_60; of planted ones others_stay (no other class from
/// below 20 % to above 80 % or back). Numbers are the claims at 90 and 60 % that are denied and borne out. \throws std::invalid_argument if a draw has
/// one outcome of its two, or for a scan without a reference.
void set_facts(std::vector<Outcome>& outcomes, const std::vector<Reference>& references);

/// For all claims of 0.1 and more whose truth is known: the planted cause and classes confirmed by
/// the whole scan are right, classes it denies are wrong.
sealed::Calibration claims_held_against(const std::vector<Outcome>& outcomes,
                                        const std::vector<Reference>& references);

}  // namespace chaintrue::planted
