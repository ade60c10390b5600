// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What the numbers of a machine may be, for reference pages and editors; problems_of
/// (model/machine.hpp) goes by the same.
#pragma once

#include <string>
#include <vector>

namespace chaintrue::model {

/// What a number of a machine may be, by its place as a JSON pointer; both ends are allowed.
struct MachineRange {
  std::string place;
  double least = 0.0;
  double most = 0.0;
  std::string unit;
};
/// Those that problems_of goes by, of a ring and of brackets, with every setting of a controller.
[[nodiscard]] std::vector<MachineRange> machine_ranges();

}  // namespace chaintrue::model
