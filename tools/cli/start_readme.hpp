// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The words that lie in the folder of chaintrue start.
#pragma once

#include <string>
#include <vector>

#include "model/machine.hpp"

namespace chaintrue::cli {

/// Expected error of the tool over the bed, one sigma, by the way of measuring.
struct StartWays {
  double marks_mm = 0.0;
  double holes_mm = 0.0;
};

/// Of a folder with the sheets in it.
[[nodiscard]] std::string start_readme(const model::Machine& machine, const StartWays& ways);
/// Of a folder with a machine file to fill in: what every key of it means.
[[nodiscard]] std::string template_readme(const std::string& machine_path);
/// The same key by key, as comments of the machine file.
[[nodiscard]] std::vector<std::string> template_comments();

}  // namespace chaintrue::cli
