// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The table of a chaintrue_machine, for the formats that hold a machine. Private to grid/files.
#pragma once

#include "grid/files/json_reader.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Includes the checks of model::problems_of; warns of uncertainties that are assumed.
[[nodiscard]] const Record<model::Machine>& machine_record();
/// An effect of the catalogue with its side and parameters; whether such an effect exists is the
/// catalogue's affair.
[[nodiscard]] const Record<model::AppliedEffect>& effect_record();
/// By GroundControl's own names.
[[nodiscard]] const Record<model::ControllerSettings>& controller_settings_record();

}  // namespace chaintrue::grid::files
