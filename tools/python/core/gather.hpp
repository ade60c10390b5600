// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What Python hands over to be fitted, checked or diagnosed, as the library takes it.
#pragma once

#include <stdexcept>
#include <vector>

#include "grid/files/holes_file.hpp"
#include "grid/observation/measured.hpp"

namespace chaintrue::python {

using Grids = std::vector<grid::MeasuredGrid>;
using HolesRead = std::vector<grid::files::ReadHoles>;

/// Grids first, then holes. \throws std::invalid_argument for holes of a machine on four belts.
[[nodiscard]] inline grid::Measured gathered(const Grids& grids, const HolesRead& holes) {
  grid::Measured measured;
  for (const grid::MeasuredGrid& grid : grids) measured.add(grid);
  for (const grid::files::ReadHoles& read : holes) {
    if (read.belt_machine) {
      throw std::invalid_argument(
          "these holes are of a machine on four belts: they are fitted with its belts alone");
    }
    measured.add(read.holes);
  }
  return measured;
}

}  // namespace chaintrue::python
