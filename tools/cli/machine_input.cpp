// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/machine_input.hpp"

#include <set>
#include <utility>

#include "grid/files/anchors_file.hpp"
#include "grid/files/belts_file.hpp"
#include "grid/files/machine_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/belts_input.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

model::Machine read_machine_input(const std::string& path) {
  static std::set<std::string> told;
  grid::files::ReadMachine read = grid::files::read_machine_with_warnings(path);
  if (told.insert(path).second) print_warnings(read.warnings);
  return std::move(read.machine);
}

model::BeltMachine read_belt_machine_input(const std::string& path) {
  const std::string text = grid::files::read_whole_file(path);
  const std::string file = grid::files::name_in_messages(path);
  if (grid::files::looks_like_anchors(text))
    return grid::files::machine_as_pasted(parse_anchors_input(text, file).fit);
  model::BeltMachine machine = grid::files::parse_belts(text, file).belts.machine;
  if (!machine.anchors_known) {
    throw grid::files::InputError(
        {{file, "/machine/anchors", "", "x_mm and y_mm of all four anchors that are in force"}});
  }
  return machine;
}

}  // namespace chaintrue::cli
