// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/warnings.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace chaintrue::cli {

void print_warnings(const std::vector<grid::files::Warning>& warnings) {
  for (const grid::files::Warning& warning : warnings)
    fmt::print(stderr, "{}\n", warning.message());
}

}  // namespace chaintrue::cli
