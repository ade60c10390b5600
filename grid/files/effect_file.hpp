// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_effect files: an effect that a user declares (model/effects/declared_effect.hpp).
///
/// \code
///   model::Machine machine = read(parse_machine, "machine.json").machine;
///   declare_effects({"second_harmonic.json"}, machine);   // machine.declared has it
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// Parses text; `file` is the name used in messages. A problem of a formula has its line and
/// column. \throws InputError with every problem.
model::effects::Declaration parse_effect(const std::string& text, const std::string& file);
std::string write_effect(const model::effects::Declaration& declaration);

/// Reads the files and adds what they declare to the machine, once each; formulas must be finite on
/// its bed and 0 at null. \throws InputError with every problem of every file.
void declare_effects(const std::vector<std::string>& paths, Machine& machine);

}  // namespace chaintrue::grid::files
