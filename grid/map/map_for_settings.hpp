// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The map of the same physical machine after its controller gets other settings. The measured
/// lengths L(x, y), R(x, y) that hold the tool at a place do not depend on typed-in numbers; these
/// change what the controller pays out for a command, and so what remains to compensate. Points
/// with commands keep the lengths paid out with the settings of that day.
///
/// \code
///   const auto typed = settings_to_type(map);
///   if (typed) write(map_for_settings(map, {kind, typed->settings}, "typed in after it was measured"));
/// \endcode
#pragma once

#include <string>

#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::grid {

/// The tool's error with the settings as stated is reported for `now`. `note` is added to the map's
/// notes, unless it is empty. \throws std::invalid_argument for a map without a machine.
CompensationMap map_for_settings(const CompensationMap& map, const model::Controller& now,
                                 const std::string& note);

/// Files whose commands went to a controller with `settings`; a file without a machine uses the
/// map's.
Measured commanded_with(const Measured& measured, const model::Controller& now);

}  // namespace chaintrue::grid
