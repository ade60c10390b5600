// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Everything that was measured of one machine: any mix of grids and sets of holes. Points and
/// distances are numbered through in the order of the files of their kind.
///
/// \code
///   Measured measured(grid);            // or a set of holes
///   measured.add(holes);
///   const auto answer = diagnosis::diagnose(measured);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/holes/measured_holes.hpp"
#include "grid/measured_grid.hpp"

namespace chaintrue::grid {

struct Measured {
  Measured() = default;
  Measured(MeasuredGrid grid) { add(std::move(grid)); }  // NOLINT: a grid is a measurement
  Measured(MeasuredHoles set) { add(std::move(set)); }   // NOLINT: and so are holes

  void add(MeasuredGrid grid) {
    take_first(grid);
    grids.push_back(std::move(grid));
  }
  void add(MeasuredHoles set) {
    take_first(set);
    holes.push_back(std::move(set));
  }

  std::string name;                       ///< of the first file
  std::optional<model::Machine> machine;  ///< that the first file states
  std::vector<MeasuredGrid> grids;
  std::vector<MeasuredHoles> holes;

 private:
  template <class File>
  void take_first(const File& file) {
    if (!grids.empty() || !holes.empty()) return;
    name = file.name;
    machine = file.machine;
  }
};

}  // namespace chaintrue::grid
