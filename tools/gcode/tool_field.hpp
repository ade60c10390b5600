// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tool's position for a command: Corrector::tool, evaluated on a lattice as needed by the
/// program and interpolated between.
///
/// Cubic Lagrange interpolation of tool(c) - c over 16 nodes, kSpacingMm apart. Every cell is
/// compared with the exact value at two points before it is used; if twice the larger difference is
/// above the bound, or a node has no value, the cell is not interpolated: each point in it is
/// computed. Error: below the bound at the checked points; docs/gcode.md states it as part of what
/// verify proves.
///
/// Not thread safe. Memory grows with the area of the program, not with its length: 4 MB for a full
/// sheet.
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>

#include "tools/gcode/corrector.hpp"

namespace chaintrue::gcode {

class ToolField {
 public:
  static constexpr double kSpacingMm = 16.0;

  /// Keeps a reference.
  ToolField(const Corrector& corrector, double bound_mm)
      : corrector_(corrector), bound_mm_(bound_mm) {}

  [[nodiscard]] tl::expected<model::BedPoint, CorrectionFailure> tool(model::BedPoint command);

  /// How far a straight command may continue from here until the tool's path bows by `flatness_mm`
  /// from its chord, by the second differences of the lattice (with a safety factor of two).
  [[nodiscard]] double straight_mm(model::BedPoint command, double flatness_mm);

 private:
  struct Node {
    double dx_mm = 0.0;
    double dy_mm = 0.0;
    bool known = false;
  };
  struct Cell {
    std::array<Node, 16> nodes;
    double curvature_per_mm = 0.0;
    bool interpolates = false;
  };

  const Cell& cell(model::BedPoint command);
  void fill(Cell& cell, std::int64_t column, std::int64_t row);
  Node node(std::int64_t column, std::int64_t row);
  static model::BedPoint interpolated(const Cell& cell, double u, double v);

  const Corrector& corrector_;
  double bound_mm_;
  std::unordered_map<std::uint64_t, Node> nodes_;
  std::unordered_map<std::uint64_t, Cell> cells_;
  std::uint64_t last_key_ = ~std::uint64_t{0};
  const Cell* last_ = nullptr;
};

}  // namespace chaintrue::gcode
