// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a file's reader assumed or found odd, said on standard error.
#pragma once

#include <vector>

#include "grid/files/input_error.hpp"

namespace chaintrue::cli {

void print_warnings(const std::vector<grid::files::Warning>& warnings);

}  // namespace chaintrue::cli
