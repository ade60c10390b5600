// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A check whose points were commanded with other settings than the map's. Those of a file; or the
/// numbers of export groundcontrol, all or some of which somebody typed in since the map was measured, or
/// has not typed in where the map is for them: then it says so, and is of the map for what is in force.
#pragma once

#include <optional>
#include <string>

#include "grid/map/map_check.hpp"
#include "model/controllers/controller.hpp"

namespace chaintrue::cli {

/// The map for what the controller holds by the file `settings`; `measured` becomes what it is as
/// commanded with these. `map_name` is what messages call the map.
/// \throws files::InputError for a bad file, settings of a wall plotter, or a map without a machine.
[[nodiscard]] grid::CompensationMap with_settings_of(const std::string& settings,
                                                     const std::string& map_name,
                                                     const grid::CompensationMap& map,
                                                     grid::Measured& measured);

/// Whether a map says that it was made from the file `from`, as that is now.
[[nodiscard]] bool was_made_from(const std::string& made, const std::string& from);

/// What the controller held when the map was measured that export made this one from, where that map lies
/// beside it unchanged.
[[nodiscard]] std::optional<model::ControllerSettings> settings_before(const std::string& map);

/// `found` is what the check of `map` against `measured` says. Nothing where the map's own settings
/// serve, or where the others do not explain the points either. The others are those of `before`,
/// what the controller held before the numbers that the map is for; else those of export groundcontrol.
[[nodiscard]] std::optional<grid::Check> with_typed_settings(const grid::CompensationMap& map,
                                                             const grid::Measured& measured,
                                                             const grid::Check& found,
                                                             std::optional<model::ControllerSettings> before = {});

}  // namespace chaintrue::cli
