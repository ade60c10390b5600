// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue fit for a chaintrue_belts file, holes that a four-belt machine cut, or both.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/cli/grid_input.hpp"

namespace chaintrue::cli {

struct BeltsFitCommand {
  Verb verb;
  /// The chaintrue_belts file, and the holes that join it; or holes alone.
  std::vector<InputFile> files;
  files::TapeOptions tape;
  std::string output;
  bool verbose = false;
  bool json = false;
  std::vector<std::size_t> without{};  ///< points left out by hand, from 1
  std::optional<double> wish_mm{};     ///< the error of the tool that the owner wishes for
};
/// True for files of such a machine.
[[nodiscard]] bool is_of_four_belts(const InputFile& file);
/// Writes the anchors to their file and the text to standard error; returns the exit code.
[[nodiscard]] int fit_the_belts(const BeltsFitCommand& command);

}  // namespace chaintrue::cli
