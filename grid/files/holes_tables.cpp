// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <iterator>
#include <string_view>
#include <utility>

#include "grid/files/holes_record.hpp"
#include "grid/files/ranges.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kHoleHeader[] = {"hole", "x_mm", "y_mm"};
constexpr std::string_view kDistanceHeader[] = {"from", "to", "distance_mm", "sigma_mm"};
// The last column is a plan's, for the user who measures.
constexpr std::string_view kPlannedHeader[] = {"from", "to", "distance_mm", "as_commanded_mm"};

// A distance between two places that were commanded, a line each.
constexpr std::string_view kBetweenHeader[] = {
    "from_x_mm", "from_y_mm", "to_x_mm", "to_y_mm", "distance_mm", "sigma_mm"};
constexpr std::string_view kMeasuredColumn = "measured_mm";  // in place of distance_mm

bool begins_with(const CsvRow& row, std::string_view word) {
  return !row.empty() && row.front().text == word;
}

/// Reports a header line that is not the one expected.
template <std::size_t n>
void check_header(const CsvRow& row,
                  const std::string_view (&names)[n],
                  std::size_t required,
                  Problems& problems) {
  std::vector<std::string> found;
  for (const CsvCell& cell : row) found.push_back(cell.text);
  while (!found.empty() && found.back().empty()) found.pop_back();
  bool fits = found.size() >= required && found.size() <= n;
  for (std::size_t i = 0; fits && i < found.size(); ++i)
    fits = found[i] == names[i] || (found[i] == kMeasuredColumn && names[i] == "distance_mm");
  if (fits) return;
  problems.add(row.front().place(),
               joined(found),
               ProblemKind::bad_table,
               "the columns {}; {}",
               fmt::join(std::begin(names), std::end(names), ","),
               kLengthsBetween);
}

/// Cells beyond the row's end read as empty, at the row's first cell.
CsvCell cell_of(const CsvRow& row, std::size_t column) {
  if (column < row.size()) return row[column];
  CsvCell absent = row.front();
  absent.text.clear();
  return absent;
}

double required_number(const CsvCell& cell,
                       std::string_view name,
                       const Range& range,
                       Problems& problems) {
  if (cell.text.empty()) {
    problems.add(cell.place(), "", ProblemKind::left_blank, "{} ({})", range.expected(), name);
    return 0.0;
  }
  return checked_number(cell.text, cell.place(), name, range, problems).value_or(0.0);
}

void read_hole_row(const CsvRow& row, StatedHoles& stated, Problems& problems) {
  Hole hole;
  hole.name = cell_of(row, 0).text;
  hole.commanded = {required_number(cell_of(row, 1), "x_mm", kHoleCoordinate, problems),
                    required_number(cell_of(row, 2), "y_mm", kHoleCoordinate, problems)};
  stated.holes.push_back(hole);
}

/// `first` is the column of the reading, behind its two ends.
void read_distance_row(const CsvRow& row,
                       StatedDistance distance,
                       std::size_t first,
                       bool has_sigma,
                       double unit,
                       StatedHoles& stated,
                       Problems& problems) {
  const std::size_t before = problems.list().size();
  const CsvCell reading = cell_of(row, first);
  if (!reading.text.empty())
    distance.distance_mm = number_in_unit(reading, unit, "distance_mm", kTapeDistance, problems);
  const CsvCell sigma = cell_of(row, first + 1);
  if (has_sigma && !sigma.text.empty()) {
    distance.sigma_mm =
        checked_number(sigma.text, sigma.place(), "sigma_mm", kTapeSigmaMm, problems);
  }
  distance.is_spoilt = problems.list().size() > before;
  stated.lines.push_back(distance);
}

/// The hole at these two cells; one that is there already has its name.
std::string hole_at(const CsvRow& row,
                    std::size_t column,
                    StatedHoles& stated,
                    Problems& problems,
                    std::vector<CsvCell>& cells) {
  const model::BedPoint at{
      required_number(cell_of(row, column), kBetweenHeader[column], kHoleCoordinate, problems),
      required_number(
          cell_of(row, column + 1), kBetweenHeader[column + 1], kHoleCoordinate, problems)};
  for (const Hole& hole : stated.holes) {
    if (hole.commanded.x_mm == at.x_mm && hole.commanded.y_mm == at.y_mm) return hole.name;
  }
  stated.holes.push_back({fmt::format("({:g}, {:g})", at.x_mm, at.y_mm), at});
  cells.push_back(cell_of(row, column));
  return stated.holes.back().name;
}

}  // namespace

HolesTables read_holes_tables(const std::string& text, double tape_unit, Problems& problems) {
  const std::vector<CsvRow> rows = split_csv(text, separator_of(text), problems);
  StatedHoles stated;
  std::vector<CsvCell> hole_cells;
  std::vector<CsvRow> distance_rows;
  enum class Table { none, holes, distances, between } table = Table::none;
  bool any_distances = false;
  bool has_sigma = true;
  for (const CsvRow& row : rows) {
    if (row.empty()) continue;
    if (begins_with(row, "hole")) {
      table = Table::holes;
      check_header(row, kHoleHeader, 3, problems);
    } else if (begins_with(row, kBetweenHeader[0])) {
      table = Table::between;
      any_distances = true;
      check_header(row, kBetweenHeader, 5, problems);
    } else if (begins_with(row, "from")) {
      table = Table::distances;
      any_distances = true;
      has_sigma = row.size() < 4 || row[3].text != kPlannedHeader[3];
      if (has_sigma) {
        check_header(row, kDistanceHeader, 3, problems);
      } else {
        check_header(row, kPlannedHeader, 4, problems);
      }
    } else if (table == Table::holes) {
      hole_cells.push_back(row.front());
      read_hole_row(row, stated, problems);
    } else if (table == Table::distances) {
      distance_rows.push_back(row);
      StatedDistance distance;
      distance.from = cell_of(row, 0).text;
      distance.to = cell_of(row, 1).text;
      read_distance_row(row, std::move(distance), 2, has_sigma, tape_unit, stated, problems);
    } else if (table == Table::between) {
      distance_rows.push_back(row);
      StatedDistance distance;
      distance.from = hole_at(row, 0, stated, problems, hole_cells);
      distance.to = hole_at(row, 2, stated, problems, hole_cells);
      read_distance_row(row, std::move(distance), 4, true, tape_unit, stated, problems);
    } else {
      problems.add(row.front().place(),
                   row.front().text,
                   ProblemKind::bad_table,
                   "a header line first: hole,x_mm,y_mm for the holes, or "
                   "from,to,distance_mm,sigma_mm for the distances");
      break;
    }
  }
  if (!problems.any() && (stated.holes.empty() || !any_distances)) {
    problems.add("",
                 stated.holes.empty() ? "no holes" : "no distances",
                 ProblemKind::missing,
                 "two tables: lines below hole,x_mm,y_mm, and lines below "
                 "from,to,distance_mm,sigma_mm; {}",
                 kLengthsBetween);
  }
  problems.throw_if_any();
  HolesPlaces places{
      "the holes",
      "the distances",
      [cells = std::move(hole_cells)](std::size_t index) { return cells[index].place(); },
      [found = std::move(distance_rows), is_between_points = table == Table::between](
          std::size_t index, std::string_view field) {
        const std::size_t ends = is_between_points ? 2 : 0;  // two columns more
        for (std::size_t c = 0; c < std::size(kDistanceHeader); ++c) {
          if (kDistanceHeader[c] == field)
            return cell_of(found[index], c + (c < 2 ? 0 : ends)).place();
        }
        return found[index].front().place();
      },
      tape_unit != 1.0 ? input_checks::Written::in_json : input_checks::Written::in_table};
  return {std::move(stated), std::move(places)};
}

}  // namespace chaintrue::grid::files
