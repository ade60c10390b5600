// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// LinuxCNC's own interpreter, if it is installed.
///
/// It is searched in RS274_ROOT (the folder that Debian's linuxcnc-uspace was unpacked into), then
/// in build/rs274, where `unpack_interpreter` puts it, then among the installed packages.
#pragma once

#include <string>
#include <vector>

#include "tests/gcode_witness/support/records.hpp"

namespace chaintrue::witness {

/// Empty if the interpreter works, otherwise how to install it.
const std::string& linuxcnc_missing();

/// LinuxCNC's answer for each program, in order, in the format of linuxcnc_moves.py. \throws
/// std::runtime_error if the interpreter fails.
std::vector<Record> ask_linuxcnc(const std::vector<Record>& programs);

}  // namespace chaintrue::witness
