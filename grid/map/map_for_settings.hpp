// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The map of the same physical machine once its controller holds other settings.
///
/// What was measured is which chain lengths hold the tool at which place: L(x, y), R(x, y). No number
/// that is typed in changes these, nor what is known of them; it changes what the controller pays out
/// for a command, and so what is left to compensate. Where points gave commands, their lengths have
/// been those that the settings of that day pay out, and stay so.
///
/// \code
///   const auto typed = settings_to_type(map);
///   if (typed) write(map_for_settings(map, {kind, typed->settings}, "typed in after it was measured"));
/// \endcode
#pragma once

#include <optional>
#include <string>

#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid {

/// How far the tool was beyond its points with the settings as stated is reported of `now`. `note` is
/// added to the map's notes, unless it is empty. \throws std::invalid_argument for a map without a
/// machine.
[[nodiscard]] CompensationMap map_for_settings(const CompensationMap& map,
                                               const model::Controller& now,
                                               const std::string& note);

/// Files whose commands went to a controller that held `settings`; a file that names no machine is
/// left to the map's.
[[nodiscard]] Measured commanded_with(const Measured& measured, const model::Controller& now);

}  // namespace chaintrue::grid
