// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/linuxcnc_kinematics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "grid/files/linuxcnc_source.hpp"

namespace chaintrue::grid::files {
namespace {

using Lengths = std::array<double, 2>;

/// Lengths at the nodes of a lattice.
struct Table {
  interp::Rectangle area;
  int columns = 0;
  int rows = 0;
  std::vector<Lengths> nodes{};  ///< row by row from below

  [[nodiscard]] double step_x() const { return (area.x_max - area.x_min) / (columns - 1); }
  [[nodiscard]] double step_y() const { return (area.y_max - area.y_min) / (rows - 1); }
  [[nodiscard]] double x(double column) const { return area.x_min + column * step_x(); }
  [[nodiscard]] double y(double row) const { return area.y_min + row * step_y(); }

  /// With one more beyond every edge (Keys, eq. 25).
  [[nodiscard]] double node(int row, int column, std::size_t side) const {
    const auto beyond = [](double a, double b, double c) { return 3.0 * a - 3.0 * b + c; };
    if (column < 0) return beyond(node(row, 0, side), node(row, 1, side), node(row, 2, side));
    if (column >= columns) {
      return beyond(node(row, columns - 1, side),
                    node(row, columns - 2, side),
                    node(row, columns - 3, side));
    }
    if (row < 0) return beyond(node(0, column, side), node(1, column, side), node(2, column, side));
    if (row >= rows) {
      return beyond(
          node(rows - 1, column, side), node(rows - 2, column, side), node(rows - 3, column, side));
    }
    return nodes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                 static_cast<std::size_t>(column)][side];
  }
};

/// Keys, eq. 4.
double between(const std::array<double, 4>& p, double t) {
  return p[1] + 0.5 * t *
                    (p[2] - p[0] + t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3] +
                                        t * (3.0 * (p[1] - p[2]) + p[3] - p[0])));
}

double interpolated(const Table& table, double column, double row, std::size_t side) {
  const int i = std::min(static_cast<int>(column), table.columns - 2);
  const int k = std::min(static_cast<int>(row), table.rows - 2);
  std::array<double, 4> along_y{};
  for (int up = 0; up < 4; ++up) {
    std::array<double, 4> along_x{};
    for (int right = 0; right < 4; ++right)
      along_x[static_cast<std::size_t>(right)] = table.node(k + up - 1, i + right - 1, side);
    along_y[static_cast<std::size_t>(up)] = between(along_x, column - i);
  }
  return between(along_y, row - k);
}

/// A length as the source holds it, with five digits after the point.
double as_written(double length_mm) { return 1e-5 * std::round(1e5 * length_mm); }

tl::expected<Table, MapFailure> tabulated(const LengthMap& map, double spacing_mm) {
  constexpr int kFewest = 4;  // what a cubic goes through
  Table table{map.domain()};
  const auto count = [&](double extent) {
    return std::max(kFewest, 1 + static_cast<int>(std::ceil(extent / spacing_mm - 1e-9)));
  };
  table.columns = count(table.area.x_max - table.area.x_min);
  table.rows = count(table.area.y_max - table.area.y_min);
  for (int row = 0; row < table.rows; ++row) {
    for (int column = 0; column < table.columns; ++column) {
      const auto lengths = map.lengths({table.x(column), table.y(row)});
      if (!lengths) return tl::unexpected(lengths.error());
      table.nodes.push_back({as_written(lengths->left_mm), as_written(lengths->right_mm)});
    }
  }
  return table;
}

tl::expected<double, MapFailure> largest_error(const LengthMap& map, const Table& table) {
  double largest = 0.0;
  for (int row = 0; row + 1 < table.rows; ++row) {
    for (int column = 0; column + 1 < table.columns; ++column) {
      for (const auto& [right, up] : {std::pair{0.5, 0.5}, std::pair{0.5, 0.0}, std::pair{0.0, 0.5}}) {
        const auto lengths = map.lengths({table.x(column + right), table.y(row + up)});
        if (!lengths) return tl::unexpected(lengths.error());
        largest = std::max(
            {largest,
             std::abs(interpolated(table, column + right, row + up, 0) - lengths->left_mm),
             std::abs(interpolated(table, column + right, row + up, 1) - lengths->right_mm)});
      }
    }
  }
  return largest;
}

std::string source_of(const Table& table, const LinuxcncNames& names) {
  std::string nodes;
  for (int row = 0; row < table.rows; ++row) {
    nodes += "    {";
    for (int column = 0; column < table.columns; ++column) {
      nodes += fmt::format("{}{{{:.5f}, {:.5f}}}",
                           column == 0 ? "" : column % 4 == 0 ? ",\n     " : ", ",
                           table.node(row, column, 0),
                           table.node(row, column, 1));
    }
    nodes += "},\n";
  }
  return linuxcnc_source({names,
                          table.columns,
                          table.rows,
                          table.area.x_min,
                          table.area.y_min,
                          table.step_x(),
                          table.step_y(),
                          nodes});
}

}  // namespace

tl::expected<LinuxcncKinematics, MapFailure> linuxcnc_kinematics(const LengthMap& map,
                                                                 const LinuxcncNames& names) {
  // A map bends least over the bed, and some centimetres next to a bump of its surface.
  constexpr double kWidestMm = 80.0, kNarrowestMm = 5.0;
  for (double spacing_mm = kWidestMm;; spacing_mm *= 0.5) {
    const auto table = tabulated(map, spacing_mm);
    if (!table) return tl::unexpected(table.error());
    const auto error = largest_error(map, *table);
    if (!error) return tl::unexpected(error.error());
    if (*error > kTableErrorMm && spacing_mm > kNarrowestMm) continue;
    return LinuxcncKinematics{source_of(*table, names),
                              table->columns,
                              table->rows,
                              std::max(table->step_x(), table->step_y()),
                              *error};
  }
}

}  // namespace chaintrue::grid::files
