// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/csv_table.hpp"
#include "grid/files/holes_record.hpp"
#include "grid/files/ranges.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kHoles = "hole";
constexpr std::string_view kDistances = "from";
// Distances between two places that were commanded.
constexpr std::string_view kBetween = "from_x_mm";

bool is_header(const CsvRow& row) {
  const std::string& first = row.front().text;
  return first == kHoles || first == kDistances || first == kBetween;
}

CsvColumn words(std::string_view name, bool is_required = true) {
  return {std::string(name), {}, is_required, true, 1.0, true};
}

/// The columns of the table whose header begins with this word. A plan's last column is for the user
/// who measures.
std::vector<CsvColumn> columns_below(std::string_view first, double tape_unit) {
  if (first == kHoles) return {words(kHoles), {"x_mm", kCoordinateMm}, {"y_mm", kCoordinateMm}};
  std::vector<CsvColumn> columns = {words(kDistances), words("to")};
  if (first == kBetween) {
    columns = {{"from_x_mm", kCoordinateMm},
               {"from_y_mm", kCoordinateMm},
               {"to_x_mm", kCoordinateMm},
               {"to_y_mm", kCoordinateMm}};
  }
  columns.push_back({"distance_mm", kTapeDistance, true, true, tape_unit});
  columns.push_back({"sigma_mm", kTapeSigmaMm, false});
  columns.push_back(words("as_commanded_mm", false));
  return columns;
}

/// The rows of a table, as long as its header: cells that a line lacks at its end are blank, what it
/// has beyond is ignored. The cell behind a distance is its sigma, headed or not.
std::vector<CsvRow> filled_rows(std::vector<CsvRow> rows) {
  CsvRow& header = rows[0];
  while (header.size() > 1 && header.back().text.empty()) header.pop_back();
  for (CsvCell& cell : header)
    if (cell.text == "measured_mm") cell.text = "distance_mm";
  if (header.back().text == "distance_mm") header.push_back({"sigma_mm"});
  for (CsvRow& row : rows) row.resize(header.size(), {"", row[0].line, row[0].column});
  return rows;
}

/// The hole at these coordinates, given its first cell. If there is one already, its name is used.
std::string hole_at(std::optional<double> x_mm, std::optional<double> y_mm, const CsvCell& cell,
                    std::vector<Hole>& holes, std::vector<CsvCell>& cells) {
  const BedPoint at{x_mm.value_or(0.0), y_mm.value_or(0.0)};
  const auto* known = find_where(holes, [&](const Hole& hole) {
    return hole.commanded.x_mm == at.x_mm && hole.commanded.y_mm == at.y_mm;
  });
  if (known != nullptr) return known->name;
  holes.push_back({fmt::format("({:g}, {:g})", at.x_mm, at.y_mm), at});
  cells.push_back(cell);
  return holes.back().name;
}

}  // namespace

HolesTables read_holes_tables(const std::string& text, double tape_unit, Problems& problems) {
  const std::vector<CsvRow> rows = split_csv(text, separator_of(text), problems);
  StatedHoles stated;
  std::vector<CsvCell> hole_cells;
  std::vector<CsvRow> distance_cells;  // the ends, the reading and its sigma
  bool any_distances = false;
  for (auto begin = rows.begin(); begin != rows.end();) {
    if (!is_header(*begin)) {
      problems.add(begin->front().place(), begin->front().text, ProblemKind::bad_table,
                   "a header line first: hole,x_mm,y_mm for the holes, or "
                   "from,to,distance_mm,sigma_mm for the distances");
      break;
    }
    const std::string& first = begin->front().text;
    const auto end = std::find_if(std::next(begin), rows.end(), is_header);
    const std::vector<CsvLine> lines =
        read_table(filled_rows({begin, end}), columns_below(first, tape_unit), problems);
    begin = end;
    any_distances = any_distances || first != kHoles;
    for (const auto& [row, cells, is_clean] : lines) {
      if (first == kHoles) {
        stated.holes.push_back({cells[0].text, {row[1].value_or(0.0), row[2].value_or(0.0)}});
        hole_cells.push_back(cells[0]);
        continue;
      }
      const bool is_between = first == kBetween;
      const std::size_t to = is_between ? 2 : 1;
      const std::size_t reading = 2 * to;
      StatedDistance& distance = stated.lines.emplace_back();
      distance.is_spoilt = false;
      distance.from =
          is_between ? hole_at(row[0], row[1], cells[0], stated.holes, hole_cells) : cells[0].text;
      distance.to =
          is_between ? hole_at(row[2], row[3], cells[2], stated.holes, hole_cells) : cells[1].text;
      distance.distance_mm = row[reading];
      distance.sigma_mm = row[reading + 1];
      distance_cells.push_back({cells[0], cells[to], cells[reading], cells[reading + 1]});
    }
  }
  if (!problems.any() && (stated.holes.empty() || !any_distances)) {
    problems.add("", stated.holes.empty() ? "no holes" : "no distances", ProblemKind::missing,
                 "two tables: lines below hole,x_mm,y_mm, and lines below "
                 "from,to,distance_mm,sigma_mm; {}",
                 kLengthsBetween);
  }
  problems.throw_if_any();
  HolesPlaces places{
      "the holes", "the distances",
      [cells = std::move(hole_cells)](std::size_t index, std::string_view) {
        return cells[index].place();
      },
      [cells = std::move(distance_cells)](std::size_t index, std::string_view field) {
        const CsvRow& own = cells[index];
        const bool is_sigma = field == "sigma_mm";
        return own[field == "to" ? 1 : field == "distance_mm" ? 2 : is_sigma ? 3 : 0].place();
      },
      tape_unit != 1.0 ? input_checks::Written::in_json : input_checks::Written::in_table};
  return {std::move(stated), std::move(places)};
}

}  // namespace chaintrue::grid::files
