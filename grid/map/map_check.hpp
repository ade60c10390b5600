// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compares a few new points with a compensation map: whether anything has changed since it was
/// measured, what, and whether re-zeroing corrects it. The possible changes are those of two chains
/// (chain_changes.hpp), with the evidence of check_evidence.hpp. K there is the noise of the new
/// readings, the map's uncertainty, and the stated placement of a new sheet.
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

/// Any mix of files. Effects of the paper and of the visit of the files' machine are removed from
/// the readings first (corrected_data.hpp), as it is for a map.
[[nodiscard]] tl::expected<Check, CheckFailure> check_map(const CompensationMap& map,
                                                          const Measured& measured,
                                                          const Progress& progress = {});

}  // namespace chaintrue::grid
