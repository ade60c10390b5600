// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A few new points against a compensation map: has anything changed since it was measured, what, and
/// does re-zeroing mend it.
///
/// What may have changed is what two chains say of it (chain_mechanism.hpp), its evidence that of
/// check_evidence.hpp. K there is the noise of the new readings, what the map does not know of itself,
/// and where a sheet lies that was laid anew, as well as its file says.
///
/// \code
///   const auto check = check_map(map, grid);          // or holes
///   if (check && check->verdict == CheckVerdict::valid) carry_on();
/// \endcode
#pragma once

#include <tl/expected.hpp>

#include "grid/map/check.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"
#include "grid/progress.hpp"

namespace chaintrue::grid {

/// Any mix of files. What the files' machine has of effects of the paper and of the visit is taken out
/// of the readings first (corrected_data.hpp), as it is for a map.
[[nodiscard]] tl::expected<Check, CheckFailure> check_map(const CompensationMap& map,
                                                          const Measured& measured,
                                                          const Progress& progress = {});

}  // namespace chaintrue::grid
