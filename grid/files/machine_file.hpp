// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_machine files. Unknown keys are errors, except "comment". Same machine, same bytes.
#pragma once

#include <filesystem>
#include <string>

#include "model/machine.hpp"

namespace chaintrue::grid::files {

/// "-" reads standard input. \throws InputError with every problem of the file.
[[nodiscard]] model::Machine read_machine(const std::filesystem::path& path);
/// Parses text; `file` is the name used in messages.
[[nodiscard]] model::Machine parse_machine(const std::string& text, const std::string& file);
[[nodiscard]] std::string write_machine(const model::Machine& machine);

}  // namespace chaintrue::grid::files
