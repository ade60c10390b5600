// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/warnings.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>

namespace chaintrue::cli {

std::string with_name(std::string message, std::string_view name) {
  if (std::getenv("CHAINTRUE_PROBLEM_NAMES") == nullptr) return message;
  return fmt::format("{} ({})", message, name);
}

void print_warnings(const std::vector<files::Warning>& warnings) {
  for (const files::Warning& warning : warnings) {
    fmt::print(stderr,
               "{}\n",
               warning.kind ? with_name(warning.message(), grid::name_of(*warning.kind))
                            : warning.message());
  }
}

}  // namespace chaintrue::cli
