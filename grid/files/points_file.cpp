// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/points_file.hpp"

#include "grid/files/csv_table.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {

std::vector<model::BedPoint> parse_points(const std::string& text, const std::string& file) {
  constexpr Range kCoordinate{"mm", -20000.0, 20000.0};
  // A plan numbers its points in the order of the walk; the lines stand in that order.
  constexpr Range kNumber{"", 0.0, 1e6};
  Problems problems(file);
  const CsvTable table = read_csv(
      text, {{"x_mm", kCoordinate}, {"y_mm", kCoordinate}, {"number", kNumber, false}}, problems);
  if (table.rows.empty() && !problems.any()) {
    problems.add("", "a header line only", "at least one line of numbers below it");
  }
  problems.throw_if_any();
  std::vector<model::BedPoint> points;
  points.reserve(table.rows.size());
  for (const auto& row : table.rows) points.push_back({row[0].value(), row[1].value()});
  return points;
}

std::vector<model::BedPoint> read_points(const std::filesystem::path& path) {
  return parse_points(read_whole_file(path), name_in_messages(path));
}

}  // namespace chaintrue::grid::files
