// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A check whose points were commanded with settings other than the map's: those of a file, or the
/// numbers of export groundcontrol if all or some were typed in since the map was measured, or not
/// typed in although the map is for them. This is reported, and the check uses the map for the
/// settings in force.
#pragma once

#include <optional>
#include <string>

#include "grid/map/map_check.hpp"
#include "model/controllers/controller.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// The map for the settings in the file `settings`; `measured` is recomputed for commands with
/// these. `map_name` is for messages.
/// \throws InputError for a bad file, settings of a wall plotter, or a map without a machine.
[[nodiscard]] CompensationMap with_settings_of(const std::string& settings,
                                               const std::string& map_name,
                                               const CompensationMap& map,
                                               grid::Measured& measured);

/// Whether a map was made from the file `from` with its present content.
[[nodiscard]] bool was_made_from(const std::string& made, const std::string& from);

/// The controller's settings for the map from which export made this one, if that map is next to it
/// unchanged.
[[nodiscard]] std::optional<model::ControllerSettings> settings_before(const std::string& map);

/// `found` is the check of `map` against `measured`. Empty if the map's settings fit, or if the
/// others do not explain the points either. The others are those of `before`, the settings before
/// the map's numbers; else those of export groundcontrol.
[[nodiscard]] std::optional<grid::Check> with_typed_settings(
    const CompensationMap& map,
    const grid::Measured& measured,
    const grid::Check& found,
    std::optional<model::ControllerSettings> before = {});

}  // namespace chaintrue::cli
