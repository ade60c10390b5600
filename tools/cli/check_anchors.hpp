// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue check of an anchors file: do the anchors still hold, by places measured since?
#pragma once

#include <string>

#include "tools/cli/input_file.hpp"

namespace chaintrue::cli {

struct AnchorsCheckCommand {
  InputFile anchors;
  InputFile belts;  ///< the new places
  std::string output = "-";
  bool json = false;
};
/// Returns an exit code. \throws grid::files::InputError.
[[nodiscard]] int check_the_anchors(const AnchorsCheckCommand& command);

}  // namespace chaintrue::cli
