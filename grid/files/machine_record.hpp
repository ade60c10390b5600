// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of a chaintrue_machine, for the formats that contain a machine. Private to grid/files.
#pragma once

#include "grid/files/json_reader.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Includes the checks of model::problems_of; warns of uncertainties that are assumed.
[[nodiscard]] const Record<model::Machine>& machine_record();
/// An effect with its side and parameters; whether it exists is checked by the catalogue.
[[nodiscard]] Record<model::AppliedEffect> effect_record();
/// By GroundControl's own names.
[[nodiscard]] Record<model::ControllerSettings> controller_settings_record();

}  // namespace chaintrue::grid::files
