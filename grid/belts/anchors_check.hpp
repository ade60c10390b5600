// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether fitted anchors still hold, from a few places that the machine has measured since: the check
/// of lengths_check.hpp with the anchors' covariance and the fit's spread, in words of belts.
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

/// A place is enough; two or three far from each other tell an anchor from a belt. The anchors are the
/// fit's; what lengths count, arm and heights are those of `belts`. Precondition: it has points.
[[nodiscard]] tl::expected<Check, CheckFailure> check_anchors(const BeltsFit& fit,
                                                              const MeasuredBelts& belts);

}  // namespace chaintrue::grid
