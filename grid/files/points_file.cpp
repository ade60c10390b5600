// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/points_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "grid/files/csv_table.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr Range kCoordinate{"mm", -20000.0, 20000.0};
constexpr Range kOrder{"", 0.0, 1e9};

// All numbered or none, each number once.
void check_numbers(const CsvTable& table, Problems& problems) {
  std::map<double, std::size_t> first_with;
  bool any = false;
  for (const auto& row : table.rows) any = any || row[2].has_value();
  for (std::size_t i = 0; any && i < table.rows.size(); ++i) {
    const CsvCell& cell = table.cells[i][2];
    const std::optional<double>& number = table.rows[i][2];
    if (!number) {
      if (table.clean[i])
        problems.add(table.cells[i].front().place(), "", "an order for every point, or for none");
    } else if (*number != std::floor(*number)) {
      problems.add(cell.place(), cell.text, "a whole number (order)");
    } else if (const auto [first, is_new] = first_with.emplace(*number, i); !is_new) {
      problems.add(cell.place(),
                   cell.text,
                   fmt::format("orders that differ; {} has this one too",
                               table.cells[first->second].front().place()));
    }
  }
}

}  // namespace

std::vector<ListedPoint> parse_points(const std::string& text, const std::string& file) {
  Problems problems(file);
  const CsvTable table = read_csv(
      text, {{"x_mm", kCoordinate}, {"y_mm", kCoordinate}, {"order", kOrder, false}}, problems);
  if (table.rows.empty() && !problems.any()) {
    problems.add("", "a header line only", "at least one line of numbers below it");
  }
  check_numbers(table, problems);
  problems.throw_if_any();
  std::vector<ListedPoint> points;
  for (const auto& row : table.rows) {
    ListedPoint point{{row[0].value(), row[1].value()}, std::nullopt};
    if (row[2]) point.order = static_cast<int>(*row[2]);
    points.push_back(point);
  }
  return points;
}

std::vector<ListedPoint> read_points(const std::filesystem::path& path) {
  return parse_points(read_whole_file(path), name_in_messages(path));
}

}  // namespace chaintrue::grid::files
