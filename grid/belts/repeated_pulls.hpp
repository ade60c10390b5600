// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The stretch of pulled belts at places that were read twice in a row with a different pull of the
/// lower belts and the upper ones unchanged. It needs no anchors.
///
///   share = mean over the pulled belts of (L_first - L_second) / L_first                    (1)
///
/// in the lengths as printed; arm and heights make a few per cent of it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "grid/belts/belts_fit.hpp"
#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

struct RepeatedPull {
  std::size_t first = 0;   ///< points
  std::size_t second = 0;  ///< the next one
  double share = 0.0;      ///< (1): positive where the second reading is shorter
  double sigma = 0.0;      ///< its sigma, from the change of the holding belts
};

/// Consecutive points, each taken once, whose belts that hold agree to a millimetre.
std::vector<RepeatedPull> repeated_pulls(const MeasuredBelts& belts);

/// The result as a sentence; empty if there are none.
std::string repeated_pulls_in_words(const MeasuredBelts& belts);

}  // namespace chaintrue::grid
