// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a file's reader assumed or found odd, said on standard error.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/files/input_error.hpp"

namespace chaintrue::cli {

/// `message (name)` where the environment has CHAINTRUE_PROBLEM_NAMES, for tests and other programs:
/// names stay when sentences change. The message alone otherwise.
[[nodiscard]] std::string with_name(std::string message, std::string_view name);

void print_warnings(const std::vector<grid::files::Warning>& warnings);

}  // namespace chaintrue::cli
