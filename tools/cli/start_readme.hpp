// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The texts in the folder of chaintrue start.
#pragma once

#include <string>
#include <vector>

#include "model/machine.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Expected error of the tool over the bed, one sigma, for each way of measuring.
struct StartWays {
  double marks_mm = 0.0;
  double holes_mm = 0.0;
};

/// For a folder with sheets.
[[nodiscard]] std::string start_readme(const Machine& machine, const StartWays& ways);
/// For a folder with a machine file to fill in: the meaning of every key.
[[nodiscard]] std::string template_readme(const std::string& machine_path);
/// The keys' meanings as comments of the machine file.
[[nodiscard]] std::vector<std::string> template_comments();

}  // namespace chaintrue::cli
