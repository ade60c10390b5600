// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Finds the distance to tape that determines the scale of four belts best: between two anchors,
/// two holes that the machine cuts, or two points of the file.
///
/// It tries all pairs of anchors and all pairs of the outermost places in eight directions, each in
/// a fit with the belts and the existing distances. A long distance determines more, but one
/// between anchors that six places leave uncertain determines less than a shorter one between
/// places.
///
/// \code
///   const auto best = distance_for_scale(belts, *fit_belts(belts));
///   if (best) say(words_of(best->distance.from), words_of(best->distance.to), best->sigma);
/// \endcode
#pragma once

#include <optional>

#include "grid/belts/belts_fit.hpp"

namespace chaintrue::grid {

/// One sigma of a long distance taped with care, mm: half a millimetre on two metres, and its ends.
inline constexpr double kTapedDistanceMm = 1.0;

struct DistanceForScale {
  BeltDistance distance;  ///< `distance_mm` is what the fit expects, in the belts' own millimetres
  double sigma = 0.0;     ///< of the scale once it is taped
};
/// Holes where the anchors in force are known, else points of the file. Empty for a fit without
/// places.
std::optional<DistanceForScale> distance_for_scale(const MeasuredBelts& belts, const BeltsFit& fit);

}  // namespace chaintrue::grid
