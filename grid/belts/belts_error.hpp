// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// By how much a router on four belts misses over the measured part of its sheet: today, and with the
/// anchors that were fitted.
///
///   today      the controller with the anchors in force, on the fitted map
///   expected   the map itself; where holes show a displacement that no anchors take out, with that
///
/// as controller_error.hpp defines an error; the sheet lies as belt_map.hpp lays it. Without a tape both
/// are in the belts' own millimetres: what the scale is off by is in neither.
///
/// \code
///   if (const auto error = error_of_belts(fit)) say(error->expected.rms_mm);
/// \endcode
#pragma once

#include <optional>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid {

struct BeltsError {
  std::optional<ErrorSummary> today;  ///< empty where the anchors in force are not known
  ErrorSummary expected;
  model::BedPoint worst_at;  ///< of `expected`
};

/// Nothing with fewer than three places and no holes, or where nothing of the raster was measured.
/// `holes` may be null.
[[nodiscard]] std::optional<BeltsError> error_of_belts(const BeltsFit& fit,
                                                       const HolesWithBelts* holes = nullptr);

}  // namespace chaintrue::grid
