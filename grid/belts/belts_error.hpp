// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The error of a four-belt router over the measured part of its sheet: with the anchors in force,
/// and with the fitted ones.
///
///   today      the controller with the anchors in force, on the fitted map
///   expected   the map itself; where holes show a displacement that no anchors take out, with that
///
/// as controller_error.hpp defines an error; the sheet lies as belt_map.hpp lays it. Without a tape
/// both are in the belts' millimetres and exclude the error of the scale.
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
  std::optional<ErrorSummary> today;  ///< empty if the anchors in force are not known
  ErrorSummary expected;
  BedPoint worst_at;  ///< of `expected`
};

/// Empty with fewer than three places and no holes, or if no raster point was measured. `holes` may
/// be null.
[[nodiscard]] std::optional<BeltsError> error_of_belts(const BeltsFit& fit,
                                                       const HolesWithBelts* holes = nullptr);

}  // namespace chaintrue::grid
