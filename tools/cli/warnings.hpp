// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Prints a reader's assumptions and warnings on standard error.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/files/input_error.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// `message (name)` if the environment has CHAINTRUE_PROBLEM_NAMES, for tests and other programs:
/// names are stable when sentences change. Otherwise only the message.
[[nodiscard]] std::string with_name(std::string message, std::string_view name);

void print_warnings(const std::vector<files::Warning>& warnings);

}  // namespace chaintrue::cli
