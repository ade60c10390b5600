// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/anchors_input.hpp"

#include <vector>

#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

grid::files::FittedAnchors parse_anchors_input(const std::string& text, const std::string& file) {
  std::vector<grid::files::Warning> warnings;
  grid::files::FittedAnchors anchors = grid::files::parse_anchors(text, file, &warnings);
  print_warnings(warnings);
  return anchors;
}

}  // namespace chaintrue::cli
