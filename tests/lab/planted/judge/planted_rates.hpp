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
#include "sealed/judge/binomial.hpp"
#include "sealed/judge/calibration.hpp"
#include "sealed/judge/rates.hpp"

namespace chaintrue::planted {

using sealed::Outcome;

/// Plain and planted.
[[nodiscard]] std::pair<Outcome, Outcome> run_draw(const Scan& scan,
                                                   const std::vector<Reference>& references,
                                                   std::uint64_t seed);

/// Sets the facts that follow from the claims, besides `order` and `named` (outright, alone or with
/// others): none_denied_90, none_denied_60, borne_out_90 and
/// borne_out_60 of plain readings; claimed_90, claimed_60, others_stay (no other class from below 20 % to
/// above 80 % or back) and none_denied_90 of planted ones. \throws std::invalid_argument if a draw has
/// one outcome of its two, or for a scan without a reference.
void set_facts(std::vector<Outcome>& outcomes, const std::vector<Reference>& references);

/// Hits among the draws of one scan.
struct Cluster {
  int hits = 0;
  int of = 0;
};
/// 95 % bounds of a rate over scans of which each has its own: the wider of the binomial ones and those of
/// Student's t with a degree of freedom less than there are scans (W. Cochran, Sampling Techniques (1977),
/// section 9A: the ratio estimate of a sample of clusters). 0 to 1 for a single scan, which carries
/// no information about another.
[[nodiscard]] sealed::RateBounds clustered_bounds(const std::vector<Cluster>& clusters);

/// For all claims of 0.1 and more whose truth is known: the planted cause and classes confirmed by
/// the whole scan are right, classes it denies are wrong.
[[nodiscard]] sealed::Calibration claims_held_against(const std::vector<Outcome>& outcomes,
                                                      const std::vector<Reference>& references);

/// As Markdown: each scan, all together, binomial bounds and those clustered by scan.
[[nodiscard]] std::string planted_table(const std::vector<Outcome>& outcomes,
                                        const std::vector<Reference>& references);
/// Rows on which two versions of the diagnosis are compared draw by draw.
[[nodiscard]] const std::vector<sealed::RateRow>& planted_rows();

}  // namespace chaintrue::planted
