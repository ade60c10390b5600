// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/points_file.hpp"

#include "grid/containers.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {

std::vector<MarkPoint> parse_points(const std::string& text, const std::string& file) {
  // A plan numbers its points in the order of visits, which is the order of the lines. Columns of
  // readings are ignored.
  constexpr Range kNumber{"", 0.0, 1e9};
  Problems problems(file);
  // A list of commands: the positions that the tool was sent to.
  const Words header = csv_header(text);
  const bool is_sheet = contains(header, "commanded_x_mm");
  const std::vector<CsvLine> lines = read_csv(text,
                                              {{"x_mm", kCoordinateMm, true, is_sheet},
                                               {"y_mm", kCoordinateMm, true, is_sheet},
                                               {"number", kNumber, false},
                                               {"order", kNumber, false},
                                               {"left_mm", kLengthMm, false},
                                               {"right_mm", kLengthMm, false},
                                               {"commanded_x_mm", kCoordinateMm, is_sheet},
                                               {"commanded_y_mm", kCoordinateMm, is_sheet}},
                                              problems);
  problems.throw_if_any();
  return mapped(lines, [x = is_sheet ? 6U : 0U](const CsvLine& line) {
    return MarkPoint{line.values[x].value(), line.values[x + 1].value()};
  });
}

std::vector<MarkPoint> read_points(const std::filesystem::path& path) {
  return parse_points(read_whole_file(path), name_in_messages(path));
}

}  // namespace chaintrue::grid::files
