// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/belts_input.hpp"

#include <fmt/format.h>

#include <vector>

#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

grid::files::FittedAnchors parse_anchors_input(const std::string& text, const std::string& file) {
  std::vector<grid::files::Warning> warnings;
  grid::files::FittedAnchors anchors = grid::files::parse_anchors(text, file, &warnings);
  print_warnings(warnings);
  return anchors;
}

grid::files::ReadBelts parse_belts_input(const std::string& text,
                                         const std::string& file,
                                         const std::string& work) {
  grid::files::ReadBelts read = grid::files::parse_belts(text, file);
  print_warnings(read.warnings);
  if (read.belts.points.size() > grid::kMostBeltPoints) {
    throw grid::files::InputError({{file,
                                    "/points",
                                    fmt::format("{} places are more than {} takes ({})",
                                                read.belts.points.size(),
                                                work,
                                                grid::kMostBeltPoints),
                                    "fewer: leave some out, evenly over the sheet"}});
  }
  return read;
}

}  // namespace chaintrue::cli
