// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The diagnosis of one session with a hidden law, a field that is no law, a listed cause or nothing:
/// which law it reports, and whether that is the hidden one.
#pragma once

#include <cstdint>
#include <string>

#include "generator/hidden/law.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

/// "laws", "two", "gaussian", ... of points on two chains; "belts_laws", ... and "holes_laws", ... of these (rows.tsv).
/// 28, 60 and 117 points in turn; 30, 56 or 90 places of four belts; 30 holes with 93 distances. Facts:
///   claimed, unclaimed      a law at kLawClaimed, or none
///   leads, in_set           the first is right, variable and place of entry; one of those reported is
///   placed, near            a law that leads has the right shape; place, period and size are within three sigmas
///   wave, predicts          it is periodic; left-out readings are predicted better than without a law
///   right, wrong            the hidden cause is named; another at kLawClaimed is
///   right_given_law, ...    the same of the names given a claimed law
/// With `in_use` a claimed law is written as a declared effect:
///   used, confirmed, denied, mistaken   it is; a second session of the same machine at other marks confirms it;
///                                       that of another machine with another law denies it, or confirms it
///   error_ratio (a number)              the tool's true error over the measured area by the first session's map
///                                       with the law offered, over that of the map without
[[nodiscard]] Outcome run_laws_trial(const std::string& kind, std::uint64_t seed,
                                     bool in_use = false);

/// Where laws of a kind of readings depend on and enter: those of the left chain or of the belt tl, each followed by
/// the others'.
struct LawEntries {
  grid::diagnosis::Coordinate length;
  grid::diagnosis::Coordinate angle;
  grid::diagnosis::Enters reading;
};
inline constexpr LawEntries kOfChains{grid::diagnosis::Coordinate::length_left,
                                      grid::diagnosis::Coordinate::angle_left,
                                      grid::diagnosis::Enters::left};
inline constexpr LawEntries kOfBelts{grid::diagnosis::Coordinate::length_tl,
                                     grid::diagnosis::Coordinate::angle_tl,
                                     grid::diagnosis::Enters::tl};

/// The laws that were found, against the hidden one, if there is one.
void judge_laws(const grid::diagnosis::Diagnosis& found, const generator::SizedLaw* hidden,
                const LawEntries& entries, Outcome& outcome);

/// Of holes that were cut and measured with a tape: "laws", "two", "gaussian", "causes" or "nothing".
[[nodiscard]] Outcome run_holes_laws_trial(const std::string& kind, std::uint64_t seed);

}  // namespace chaintrue::sealed
