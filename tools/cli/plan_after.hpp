// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue plan FILE --after: what to measure next, as a list for the workshop, as lines for the
/// files that were diagnosed, and as a drawing.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::cli {

struct PlanAfterOptions {
  std::string file;  ///< a grid, holes or belts
  std::string after;
  std::vector<std::string> with;  ///< the other files of the same diagnosis
  std::string machine;
  std::string output = "-";
  std::string drawing;
};

/// \throws files::InputError. Returns an exit code.
[[nodiscard]] int plan_after(const PlanAfterOptions& options);

}  // namespace chaintrue::cli
