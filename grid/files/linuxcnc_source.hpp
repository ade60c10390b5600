// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The text (C) of a kinematics module of LinuxCNC around its table. Private to grid/files.
#pragma once

#include <string>

#include "grid/files/linuxcnc_kinematics.hpp"

namespace chaintrue::grid::files {

struct LinuxcncTable {
  LinuxcncNames names;
  int columns = 0;
  int rows = 0;
  double x_mm = 0.0;  ///< of the first node
  double y_mm = 0.0;
  double step_x_mm = 0.0;
  double step_y_mm = 0.0;
  std::string nodes;  ///< as an initialiser, a row in braces each
};

/// Same table, same bytes.
[[nodiscard]] std::string linuxcnc_source(const LinuxcncTable& table);

}  // namespace chaintrue::grid::files
