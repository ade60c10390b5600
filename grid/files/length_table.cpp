// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/length_table.hpp"

#include <cmath>
#include <utility>
#include "grid/containers.hpp"

namespace chaintrue::grid::files {
namespace {

/// Keys, eq. 4.
double between(const std::array<double, 4>& p, double t) {
  return p[1] + 0.5 * t *
                    (p[2] - p[0] +
                     t * (2.0 * p[0] - 5.0 * p[1] + 4.0 * p[2] - p[3] +
                          t * (3.0 * (p[1] - p[2]) + p[3] - p[0])));
}

double interpolated(const LengthTable& table, double column, double row, std::size_t side) {
  const int i = std::min(static_cast<int>(column), table.columns - 2);
  const int k = std::min(static_cast<int>(row), table.rows - 2);
  std::array<double, 4> along_y{};
  for (const int up : each_below(4)) {
    std::array<double, 4> along_x{};
    for (const int right : each_below(4))
      along_x[as_size(right)] = table.node(k + up - 1, i + right - 1, side);
    along_y[as_size(up)] = between(along_x, column - i);
  }
  return between(along_y, row - k);
}

/// A length as written to the source, with five digits after the point.
double as_written(double length_mm) { return 1e-5 * std::round(1e5 * length_mm); }

tl::expected<LengthTable, MapFailure> tabulated(const LengthMap& map, double spacing_mm) {
  constexpr int kFewest = 4;  // what a cubic goes through
  LengthTable table{map.domain()};
  const auto count = [&](double extent) {
    return std::max(kFewest, 1 + static_cast<int>(std::ceil(extent / spacing_mm - 1e-9)));
  };
  table.columns = count(table.area.x_max - table.area.x_min);
  table.rows = count(table.area.y_max - table.area.y_min);
  for (const int row : each_below(table.rows)) {
    for (const int column : each_below(table.columns)) {
      const auto lengths = map.lengths({table.x(column), table.y(row)});
      if (!lengths) return failed(lengths);
      table.nodes.push_back({as_written(lengths->left_mm), as_written(lengths->right_mm)});
    }
  }
  return table;
}

tl::expected<double, MapFailure> largest_error(const LengthMap& map, const LengthTable& table) {
  double largest = 0.0;
  for (int row = 0; row + 1 < table.rows; ++row) {
    for (int column = 0; column + 1 < table.columns; ++column) {
      for (const auto& [right, up] :
           {std::pair{0.5, 0.5}, std::pair{0.5, 0.0}, std::pair{0.0, 0.5}}) {
        const auto lengths = map.lengths({table.x(column + right), table.y(row + up)});
        if (!lengths) return failed(lengths);
        largest = std::max(
            {largest, std::abs(interpolated(table, column + right, row + up, 0) - lengths->left_mm),
             std::abs(interpolated(table, column + right, row + up, 1) - lengths->right_mm)});
      }
    }
  }
  return largest;
}

}  // namespace

double LengthTable::node(int row, int column, std::size_t side) const {
  // Beyond an edge, from the three nodes next to it.
  const auto beyond = [&](int up, int right) {
    const auto inner = [&](int k) { return node(row + k * up, column + k * right, side); };
    return 3.0 * inner(1) - 3.0 * inner(2) + inner(3);
  };
  if (column < 0) return beyond(0, 1);
  if (column >= columns) return beyond(0, -1);
  if (row < 0) return beyond(1, 0);
  if (row >= rows) return beyond(-1, 0);
  return nodes[as_size(row) * as_size(columns) + as_size(column)][side];
}

std::string LengthTable::nodes_as_text(std::string_view open, std::string_view close) const {
  std::string text;
  for (const int row : each_below(rows)) {
    text += fmt::format("    {}", open);
    for (const int column : each_below(columns)) {
      text += fmt::format("{}{}{:.5f}, {:.5f}{}",
                          column == 0       ? ""
                          : column % 4 == 0 ? ",\n     "
                                            : ", ",
                          open, node(row, column, 0), node(row, column, 1), close);
    }
    text += fmt::format("{},\n", close);
  }
  return text;
}

tl::expected<LengthTable, MapFailure> length_table(const LengthMap& map) {
  // A map bends least over the bed, and some centimetres next to a bump of its surface.
  constexpr double kWidestMm = 80.0, kNarrowestMm = 5.0;
  for (double spacing_mm = kWidestMm;; spacing_mm *= 0.5) {
    auto table = tabulated(map, spacing_mm);
    if (!table) return failed(table);
    const auto error = largest_error(map, *table);
    if (!error) return failed(error);
    if (*error > kTableErrorMm && spacing_mm > kNarrowestMm) continue;
    table->largest_error_mm = *error;
    return table;
  }
}

}  // namespace chaintrue::grid::files
