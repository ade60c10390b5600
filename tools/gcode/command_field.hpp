// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The command for a target, Corrector::command without play, from tables that are made in regions
/// where a program cuts often.
///
/// The map's bounds are divided into tiles. A tile is tabulated (interp::CompiledPair, of the
/// correction) once as many targets in it have been computed as the table costs, so that no program
/// takes more than twice as long as without tables. Each cell of a table is compared with the exact
/// value at five points; if 1.25 times the largest difference is above the bound, finer cells are
/// tried, and at last every target is computed. Targets are also computed outside the bounds, and
/// in a tile where some point has no answer.
///
/// Error: below the bound at the checked points. Memory: 16 kB for each tile, 0.8 MB for a full
/// sheet; 16 times that with the finest cells. Not thread safe.
#pragma once

#include <optional>
#include <vector>

#include "interp/compiled_pair.hpp"
#include "tools/gcode/corrector.hpp"

namespace chaintrue::gcode {

class CommandField {
 public:
  /// Keeps a reference.
  CommandField(const Corrector& corrector, double bound_mm);

  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> command(model::BedPoint target);

 private:
  struct Tile {
    std::optional<interp::CompiledPair> table;
    int cells = 8;  ///< on each side, of the next table
    int computed = 0;
  };

  Tile* tile(model::BedPoint target);
  void tabulate(Tile& tile);

  const Corrector& corrector_;
  double bound_mm_;
  interp::Rectangle bounds_;
  int columns_;
  int rows_;
  std::vector<Tile> tiles_;
};

}  // namespace chaintrue::gcode
