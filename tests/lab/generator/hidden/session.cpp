// SPDX-License-Identifier: GPL-3.0-or-later
#include "generator/hidden/session.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <string>

namespace chaintrue::generator {

std::string_view word(Order order) {
  constexpr std::string_view kWords[] = {"rows", "columns", "serpentine_rows", "serpentine_columns",
                                         "random"};
  return kWords[static_cast<std::size_t>(order)];
}

Layout layout_of(int points) {
  constexpr int kLayouts[][2] = {{7, 4}, {10, 6}, {13, 9}, {20, 10}, {31, 15}};
  for (const auto& [columns, rows] : kLayouts) {
    if (columns * rows == points) return {columns, rows};
  }
  throw std::invalid_argument("layout_of: " + std::to_string(points) + " marks");
}

std::vector<PlannedVisit> plan_visits(const Layout& layout, Order order, Dice& dice) {
  const bool by_rows = order == Order::rows || order == Order::serpentine_rows;
  const bool serpentine = order == Order::serpentine_rows || order == Order::serpentine_columns;
  const int outer = by_rows ? layout.rows : layout.columns;
  const int inner = by_rows ? layout.columns : layout.rows;
  std::vector<PlannedVisit> marks;
  for (int o = 0; o < outer; ++o) {
    for (int k = 0; k < inner; ++k) {
      const int i = serpentine && o % 2 == 1 ? inner - 1 - k : k;
      const int column = by_rows ? i : o;
      const int row = by_rows ? o : i;
      const double u = 2.0 * column / (layout.columns - 1) - 1.0;
      const double v = 2.0 * row / (layout.rows - 1) - 1.0;
      marks.push_back({{u * layout.half_width_mm, v * layout.half_height_mm}, 0, false});
    }
  }
  if (order == Order::random) dice.shuffle(marks);
  for (std::size_t i = 0; i < marks.size(); ++i) marks[i].mark = i;

  // The k-th repeat comes after (k + 1) / (repeats + 1) of the marks, the last at the end.
  std::vector<PlannedVisit> visits;
  const auto repeats = static_cast<std::size_t>(layout.repeats);
  std::vector<bool> taken(marks.size(), false);
  std::size_t next = 0;
  for (std::size_t k = 0; k < repeats; ++k) {
    const std::size_t done = std::max<std::size_t>(k + 1, (k + 1) * marks.size() / repeats);
    while (next < done) visits.push_back(marks[next++]);
    std::size_t again = dice.below(done);
    while (taken[again]) again = dice.below(done);
    taken[again] = true;
    PlannedVisit repeat = marks[again];
    repeat.repeat = true;
    visits.push_back(repeat);
  }
  while (next < marks.size()) visits.push_back(marks[next++]);
  return visits;
}

std::vector<PlannedVisit> list_of_start() {
  constexpr double kColumns[] = {-1119.0, -969.0, -559.0, 0.0, 559.0, 969.0, 1119.0};
  constexpr double kRows[] = {-509.0, -254.0, 254.0, 509.0};
  std::vector<PlannedVisit> visits;
  std::vector<PlannedVisit> marks;
  for (std::size_t row = 0; row < std::size(kRows); ++row) {
    for (std::size_t k = 0; k < std::size(kColumns); ++k) {
      const std::size_t column = row % 2 == 0 ? k : std::size(kColumns) - 1 - k;
      marks.push_back({{kColumns[column], kRows[row]}, marks.size(), false});
      visits.push_back(marks.back());
    }
    PlannedVisit again = row + 1 < std::size(kRows) ? marks[marks.size() - 6] : marks.front();
    again.repeat = true;
    visits.push_back(again);
  }
  return visits;
}

}  // namespace chaintrue::generator
