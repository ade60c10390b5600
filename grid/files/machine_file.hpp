// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_machine files. Unknown keys are errors, except "comment". Same machine, same bytes.
///
/// \code
///   const ReadMachine found = read(parse_machine, "machine.json");
///   for (const Warning& warning : found.warnings) fmt::print(stderr, "{}\n", warning.message());
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

struct ReadMachine {
  Machine machine;
  /// What was assumed because the file does not state it.
  std::vector<Warning> warnings;
};

/// `file` is the name used in messages. \throws InputError with every problem of the file.
ReadMachine parse_machine(const std::string& text, const std::string& file);
/// `comments` go under the key "comment", one line each; readers ignore them. \throws
/// std::logic_error where a number of the machine is not finite.
std::string write_machine(const Machine& machine, const std::vector<std::string>& comments = {});

}  // namespace chaintrue::grid::files
