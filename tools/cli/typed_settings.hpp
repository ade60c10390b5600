// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A check whose points were commanded with other settings than the map's. Those of a file; or the
/// numbers of export groundcontrol, which somebody typed in since the map was measured: then it says
/// so, and is of the map for these.
#pragma once

#include <optional>
#include <string>

#include "grid/map/map_check.hpp"

namespace chaintrue::cli {

/// The map for what the controller holds by the file `settings`; `measured` becomes what it is as
/// commanded with these. `map_name` is what messages call the map.
/// \throws files::InputError for a bad file, settings of a wall plotter, or a map without a machine.
[[nodiscard]] grid::CompensationMap with_settings_of(const std::string& settings,
                                                     const std::string& map_name,
                                                     const grid::CompensationMap& map,
                                                     grid::Measured& measured);

/// `found` is what the check of `map` against `measured` says. Nothing where the map's own settings
/// serve, or where those of export groundcontrol do not explain the points either.
[[nodiscard]] std::optional<grid::Check> with_typed_settings(const grid::CompensationMap& map,
                                                             const grid::Measured& measured,
                                                             const grid::Check& found);

}  // namespace chaintrue::cli
