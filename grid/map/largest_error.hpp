// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The bound of the largest of many errors in 95 of 100 sessions.
///
///   e(p) = m(p) + S(p) z,   z ~ N(0, 1)                                                     (1)
///
/// m is the expected error at a place, S its uncertainty (LengthMap::tool_spread), z the same at
/// all places: the bound is the 95 % quantile of max |e(p)| over draws of z. Errors at neighbouring
/// places are correlated, so neither the largest sigma nor a sum of probabilities gives it. Same
/// places, same bound.
///
/// S is averaged over the size of the noise, which few repeats leave uncertain (interp/reml.hpp). Normal z of that
/// variance replace Student's t: with 12 degrees of freedom 2.15 for 2.18 at 95 %.
///
/// \code
///   LargestError largest;
///   for (const auto& place : places) largest.add(place.error_mm, place.spread_mm);
///   say(largest.bound_mm());
/// \endcode
#pragma once

#include <vector>

#include "grid/map/compensation_map.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

// A map with a larger expected error, for reasons that the fit cannot see. Its lengths are
// unchanged.
//
// \code
//   // The truth may be another map, with probability p: variances about this one.
//   const auto wider = with_differences(map, {{map, other, std::sqrt(p)}});
// \endcode

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

class LargestError {
 public:
  /// \throws std::invalid_argument if the number of columns of `spread_mm` changes.
  void add(const Vector2d& expected_mm, const Matrix2Xd& spread_mm);
  /// 0 without places.
  double bound_mm() const;

 private:
  MatrixXd draws_;        ///< of z, a row each
  VectorXd largest_mm2_;  ///< of each draw
};

}  // namespace chaintrue::grid
