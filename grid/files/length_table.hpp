// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The lengths of a map at the nodes of a regular lattice, for controllers that interpolate in a table.
///
/// Between nodes lengths are interpolated by cubic convolution in x and in y (R. Keys, IEEE Trans.
/// Acoust. Speech Signal Process. 29 (1981), 1153, eq. 4 and the boundary values of eq. 25). The
/// table is as dense as necessary: its error is evaluated in the middles of cells and of their
/// sides, where it is largest.
///
/// \code
///   const auto table = length_table(MapInFrame(map));
///   if (table) write(table->columns, table->rows, table->largest_error_mm);
/// \endcode
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "grid/failed.hpp"
#include "grid/map/length_map.hpp"

namespace chaintrue::grid::files {

/// Largest allowed error, mm: a hundredth of a careful reading.
inline constexpr double kTableErrorMm = 0.005;

struct LengthTable {
  interp::Rectangle area;
  int columns = 0;
  int rows = 0;
  /// Left and right, row by row from below, to five digits after the point.
  std::vector<std::array<double, 2>> nodes{};
  /// Largest error of a length as evaluated; above kTableErrorMm only if a spacing of 5 mm is not
  /// enough.
  double largest_error_mm = 0.0;

  double step_x() const { return (area.x_max - area.x_min) / (columns - 1); }
  double step_y() const { return (area.y_max - area.y_min) / (rows - 1); }
  double x(double column) const { return area.x_min + column * step_x(); }
  double y(double row) const { return area.y_min + row * step_y(); }
  /// The larger distance of neighbours.
  double spacing_mm() const { return std::max(step_x(), step_y()); }
  /// side: 0 left, 1 right. One row or column beyond an edge it is continued (Keys, eq. 25).
  double node(int row, int column, std::size_t side) const;
  /// All nodes as text, four to a line; each row and each node is between `open` and `close`.
  std::string nodes_as_text(std::string_view open, std::string_view close) const;
};

/// A kinematics module that interpolates in a table.
struct TableModule : LengthTable {
  std::string source;
};

/// The text with the table's {columns}, {rows}, {x}, {y}, {step_x} and {step_y}, the {module}'s name
/// and, for a comment, the map's {name}, and whatever `more` names.
template <class... More>
std::string with_table(std::string_view text, const LengthTable& table, const std::string& module,
                       std::string name, const More&... more) {
  for (char& c : name) c = static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  return fmt::format(fmt::runtime(text), fmt::arg("name", name), fmt::arg("module", module),
                     fmt::arg("columns", table.columns), fmt::arg("rows", table.rows),
                     fmt::arg("x", table.area.x_min), fmt::arg("y", table.area.y_min),
                     fmt::arg("step_x", table.step_x()), fmt::arg("step_y", table.step_y()),
                     more...);
}

/// Over the map's domain. Fails if the map has no answer somewhere in it.
[[nodiscard]] tl::expected<LengthTable, MapFailure> length_table(const LengthMap& map);

}  // namespace chaintrue::grid::files
