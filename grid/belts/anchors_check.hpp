// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Checks whether fitted anchors are still valid, from a few places measured since:
/// lengths_check.hpp with the anchors' covariance and the fit's spread, in terms of belts.
///
/// \code
///   const auto check = check_anchors(fit, new_belts);
///   if (check) say(check->sentence);
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "grid/belts/belts_fit.hpp"
#include "grid/map/check.hpp"

namespace chaintrue::grid {

/// One place is enough; two or three far apart distinguish an anchor from a belt. Anchors are taken
/// from the fit; the kind of length, arm and heights from `belts`. Precondition: it has points.
[[nodiscard]] tl::expected<Check, CheckFailure> check_anchors(const BeltsFit& fit,
                                                              const MeasuredBelts& belts);

}  // namespace chaintrue::grid
