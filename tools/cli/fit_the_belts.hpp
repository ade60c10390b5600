// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue fit of a chaintrue_belts file.
#pragma once

#include <string>

namespace chaintrue::cli {

struct BeltsFitCommand {
  std::string text;
  std::string file;  ///< in messages
  std::string output;
  bool verbose = false;
  bool json = false;
};
/// Anchors go to their file, the words to standard error. An exit code.
[[nodiscard]] int fit_the_belts(const BeltsFitCommand& command);

}  // namespace chaintrue::cli
