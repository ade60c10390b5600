// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/machine_input.hpp"

#include <set>
#include <utility>

#include "grid/files/machine_file.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

model::Machine read_machine_input(const std::string& path) {
  static std::set<std::string> told;
  grid::files::ReadMachine read = grid::files::read_machine_with_warnings(path);
  if (told.insert(path).second) print_warnings(read.warnings);
  return std::move(read.machine);
}

}  // namespace chaintrue::cli
