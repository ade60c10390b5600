// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_machine files. Unknown keys are errors, except "comment". Same machine, same bytes.
///
/// \code
///   const ReadMachine read = read_machine_with_warnings("machine.json");
///   for (const Warning& warning : read.warnings) fmt::print(stderr, "{}\n", warning.message());
/// \endcode
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

struct ReadMachine {
  model::Machine machine;
  /// What was assumed because the file does not state it.
  std::vector<Warning> warnings;
};

/// "-" reads standard input. \throws InputError with every problem of the file.
[[nodiscard]] model::Machine read_machine(const std::filesystem::path& path);
[[nodiscard]] ReadMachine read_machine_with_warnings(const std::filesystem::path& path);
/// Parses text; `file` is the name used in messages.
[[nodiscard]] model::Machine parse_machine(const std::string& text, const std::string& file);
[[nodiscard]] ReadMachine parse_machine_with_warnings(const std::string& text,
                                                      const std::string& file);
/// `comments` go under the key "comment", one line each; readers ignore them. \throws
/// std::logic_error where a number of the machine is not finite.
[[nodiscard]] std::string write_machine(const model::Machine& machine,
                                        const std::vector<std::string>& comments = {});

}  // namespace chaintrue::grid::files
