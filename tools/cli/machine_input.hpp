// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The machine that a verb works with; what its file does not say, and is assumed, is told on
/// standard error.
#pragma once

#include <string>

#include "model/belts/belt_machine.hpp"
#include "model/machine.hpp"

namespace chaintrue::cli {

/// "-" is standard input. A file that is read again says nothing new. \throws files::InputError.
[[nodiscard]] model::Machine read_machine_input(const std::string& path);

/// What the controller of four belts believes: of a chaintrue_belts file the anchors in force, of a
/// chaintrue_anchors file those that were fitted, as export maslow4 has them pasted. \throws
/// files::InputError.
[[nodiscard]] model::BeltMachine read_belt_machine_input(const std::string& path);

}  // namespace chaintrue::cli
