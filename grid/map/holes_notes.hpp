// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What is said of a fit of distances. Private to grid/map.
#pragma once

#include <string>
#include <vector>

#include "grid/map/holes_fit.hpp"

namespace chaintrue::grid {

/// What was set aside and why, and what is suspected of the tape.
[[nodiscard]] std::vector<std::string> distance_notes(const MeasuredHoles& set,
                                                      const FittedDistances& fit);
/// The same, what is off, and what the map is.
[[nodiscard]] std::vector<std::string> fit_notes(const MeasuredHoles& set, const HolesFit& fit);

}  // namespace chaintrue::grid
