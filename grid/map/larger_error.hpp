// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map with a larger expected error, for reasons that the fit cannot see. Its lengths are
/// unchanged.
///
/// \code
///   // The truth may be another map, with probability p: variances about this one.
///   const auto wider = with_differences(map, {{map, other, std::sqrt(p)}});
/// \endcode
#pragma once

#include <vector>

#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid {

/// Everywhere, by a factor of at least 1. \throws std::invalid_argument for a map without a
/// machine, or a smaller factor.
[[nodiscard]] CompensationMap with_larger_error(const CompensationMap& map, double factor);

/// One sigma of one direction: `share` times the difference of the lengths of `to` from those of
/// `from`, at all places together.
struct MapDifference {
  const CompensationMap& from;
  const CompensationMap& to;
  double share;
};
/// The covariance of the map's lengths with that of such directions, as far as its splines can follow them.
/// \throws std::invalid_argument for a map without a machine.
[[nodiscard]] CompensationMap with_differences(const CompensationMap& map,
                                               const std::vector<MapDifference>& differences);

}  // namespace chaintrue::grid
