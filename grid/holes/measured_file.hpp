// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A file of measurements among others, as messages name it.
#pragma once

#include <string>
#include <variant>

#include "grid/holes/measured_holes.hpp"
#include "grid/measured_grid.hpp"

namespace chaintrue::grid {

struct MeasuredFile {
  std::string name;  ///< in messages
  std::variant<MeasuredGrid, MeasuredHoles> measured;
};

}  // namespace chaintrue::grid
