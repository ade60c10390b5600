// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// LinuxCNC's own interpreter, where it is present.
///
/// It is looked for where RS274_ROOT says (the folder that Debian's linuxcnc-uspace was unpacked
/// into), then in build/rs274, where `unpack_interpreter` puts it, then among the installed
/// packages.
#pragma once

#include <string>
#include <vector>

#include "tests/gcode_witness/support/records.hpp"

namespace chaintrue::witness {

/// Empty where the interpreter answers, otherwise what to do so that it does.
[[nodiscard]] const std::string& linuxcnc_missing();

/// The truth of each program, in order, as linuxcnc_moves.py writes it.
/// \throws std::runtime_error where the interpreter does not answer.
[[nodiscard]] std::vector<Record> ask_linuxcnc(const std::vector<Record>& programs);

}  // namespace chaintrue::witness
