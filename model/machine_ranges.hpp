// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Ranges of a machine's numbers, for reference pages and editors; the same ranges as in
/// problems_of (model/machine.hpp).
#pragma once

#include <string>
#include <vector>

namespace chaintrue::model {

/// Range of a number of a machine, by its JSON pointer; both ends are allowed.
struct MachineRange {
  std::string place;
  double least = 0.0;
  double most = 0.0;
  std::string unit;
};
/// The ranges of problems_of for a ring and for brackets, with every setting of a controller.
[[nodiscard]] std::vector<MachineRange> machine_ranges();

}  // namespace chaintrue::model
