// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/map_input.hpp"

#include <vector>

#include "grid/files/anchors_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/warnings.hpp"
#include "grid/printing.hpp"

namespace chaintrue::cli {

namespace files = grid::files;

namespace {

std::string& trusted() {
  static std::string name;
  return name;
}

}  // namespace

const std::string& map_on_trust() { return trusted(); }

grid::CompensationMap parse_map_input(const std::string& text, const std::string& file) {
  if (files::looks_like_anchors(text)) {
    throw files::InputError(
        {{file,
          "/file_type",
          "\"chaintrue_anchors\"",
          "\"chaintrue_map\"; anchors of four belts are taken by chaintrue query, report, check, "
          "gcode and export maslow4"}});
  }
  std::vector<files::Warning> warnings;
  grid::CompensationMap map = files::parse_map(text, file, &warnings);
  print_warnings(warnings);
  if (!warnings.empty()) trusted() = file;
  return map;
}

grid::CompensationMap read_map_input(const std::string& path) {
  return parse_map_input(files::read_whole_file(path), files::name_in_messages(path));
}

}  // namespace chaintrue::cli
