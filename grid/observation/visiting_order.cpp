// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/visiting_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/plane_vectors.hpp"

namespace chaintrue::grid {
namespace {

constexpr double kLineGapShare = 0.25;
/// Marks farther apart across a line than this many gaps are not a line.
constexpr double kWidestLine = 2.0;
/// Fewest marks per line on average.
constexpr double kFewestALine = 2.0;

/// A mark along and across the lines: lines follow each other by rising `across`.
struct MarkInLine {
  std::size_t index = 0;
  double across_mm = 0.0;
  double along_mm = 0.0;
};

MarkInLine in_line(const MarkPoint& mark, std::size_t index, const VisitingOrder& order) {
  const double x = order.from_right ? -mark.x_mm : mark.x_mm;
  const double y = order.from_below ? mark.y_mm : -mark.y_mm;
  return order.rows ? MarkInLine{index, y, x} : MarkInLine{index, x, y};
}

struct Visits {
  std::vector<MarkInLine> first;
  Indices again;
};

Visits visits_of(const std::vector<MeasuredPoint>& points, const VisitingOrder& order) {
  Visits visits;
  for (const auto i : each_index(points)) {
    const MarkPoint& mark = points[i].mark;
    const bool again = any_of(visits.first, [&](const MarkInLine& place) {
      const MarkPoint& other = points[place.index].mark;
      return distance_mm(other, mark) <= kRepeatDistanceMm;
    });
    if (again) {
      visits.again.push_back(i);
    } else {
      visits.first.push_back(in_line(mark, i, order));
    }
  }
  return visits;
}

/// Side of the square that one mark has to itself.
double usual_spacing_mm(const std::vector<MarkInLine>& marks) {
  const auto extent_mm = [&marks](double MarkInLine::*number) {
    const auto [low, high] = minmax_element(marks, ascending(number));
    return *high.*number - *low.*number;
  };
  return std::sqrt(extent_mm(&MarkInLine::across_mm) * extent_mm(&MarkInLine::along_mm) /
                   as_double(marks.size()));
}

/// Sorted across; empty if the marks are not in lines.
std::vector<std::vector<MarkInLine>> lines_of(std::vector<MarkInLine> marks) {
  stable_sort(marks, ascending(&MarkInLine::across_mm));
  const double gap_mm = kLineGapShare * usual_spacing_mm(marks);
  std::vector<std::vector<MarkInLine>> lines(1);
  for (const MarkInLine& mark : marks) {
    if (!lines.back().empty() && mark.across_mm - lines.back().back().across_mm > gap_mm)
      lines.emplace_back();
    lines.back().push_back(mark);
  }
  const bool is_blurred = any_of(lines, [&](const auto& line) {
    return line.back().across_mm - line.front().across_mm > kWidestLine * gap_mm;
  });
  if (is_blurred || lines.size() < 2 ||
      as_double(marks.size()) < kFewestALine * as_double(lines.size()))
    return {};
  return lines;
}

}  // namespace

std::vector<VisitingOrder> line_by_line_orders() {
  std::vector<VisitingOrder> all;
  for (const bool rows : {true, false}) {
    for (const bool serpentine : {false, true}) {
      for (const bool from_right : {false, true}) {
        for (const bool from_below : {false, true})
          all.push_back({rows, serpentine, from_right, from_below});
      }
    }
  }
  return all;
}

tl::expected<std::vector<int>, std::string> visit_numbers(const std::vector<MeasuredPoint>& points,
                                                          const VisitingOrder& order) {
  if (points.empty()) return std::vector<int>();
  const Visits visits = visits_of(points, order);
  std::vector<std::vector<MarkInLine>> lines = lines_of(visits.first);
  if (lines.empty()) {
    return tl::unexpected(
        fmt::format("marks that are in {}; these are not", order.rows ? "rows" : "columns"));
  }
  std::vector<int> numbers(points.size());
  int visit = 0;
  for (const auto line : each_index(lines)) {
    stable_sort(lines[line], ascending(&MarkInLine::along_mm));
    if (order.serpentine && line % 2 == 1) std::reverse(lines[line].begin(), lines[line].end());
    for (const MarkInLine& mark : lines[line]) numbers[mark.index] = visit++;
  }
  for (const std::size_t index : visits.again) numbers[index] = visit++;
  return numbers;
}

std::string in_words(const VisitingOrder& order) {
  return fmt::format("{}{}, from the {} {}", order.rows ? "row by row" : "column by column",
                     order.serpentine ? ", in alternating directions" : ", all in one direction",
                     order.from_below ? "bottom" : "top", order.from_right ? "right" : "left");
}

}  // namespace chaintrue::grid
