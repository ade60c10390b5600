// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tool's error by a map over the area of the marks, against the hidden machine, and the map's
/// stated error. A map answers without drift, skips and hysteresis, so the hidden machine is asked
/// without them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "generator/hidden/draw.hpp"
#include "grid/map/compensation_map.hpp"

namespace chaintrue::sealed {

struct MapErrors {
  double true_rms_mm = 0.0;    ///< of the tool
  double stated_rms_mm = 0.0;  ///< its expected error at the same places
  int places = 0;
  /// Places at which each chain's true length lies within 1.96 of the map's sigmas, two a place.
  int covered = 0;
};

/// Nothing where the hidden machine or the map cannot answer at a place.
std::optional<MapErrors> map_errors(const generator::SealedSet& set,
                                    const grid::CompensationMap& map);

/// The readings of the list of `chaintrue start`: what the controller pays out, a tenth of a millimetre off,
/// at marks that are read to half a millimetre.
generator::Recipe recipe_of_start();

/// Readings of the same machine in another session over the same marks, without what happened at a visit of
/// the first, the zero of its left chain more by `zero_mm`: the text of a grid.
std::string another_session(const generator::SealedSet& set, double zero_mm, std::uint64_t seed);

/// For holes without edges: with the best placement of the sheet, since distances between holes do
/// not depend on it.
std::optional<MapErrors> map_errors_of_free_sheet(const generator::HiddenMachine& machine,
                                                  const grid::CompensationMap& map);

}  // namespace chaintrue::sealed
