// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/assumed_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace chaintrue::cli {
namespace {

using grid::MeasuredPoint;
using grid::files::VisitOrder;

constexpr double kRepeatDistanceMm = 25.0;
constexpr double kLineGapShare = 0.25;
/// Marks further apart than so many gaps across a line are no line but a cloud.
constexpr double kWidestLine = 2.0;
/// Fewer marks a line than this on average are no lines.
constexpr double kFewestALine = 2.0;

struct Word {
  const char* word;
  VisitOrder order;
};
constexpr Word kWords[] = {{"rows", VisitOrder::rows},
                           {"columns", VisitOrder::columns},
                           {"serpentine_rows", VisitOrder::serpentine_rows},
                           {"serpentine_columns", VisitOrder::serpentine_columns}};

/// A mark seen along and across the lines: lines follow each other by rising `across`.
struct PlaceInTurn {
  std::size_t index = 0;
  double across_mm = 0.0;
  double along_mm = 0.0;
};

bool is_second_visit(const std::vector<MeasuredPoint>& points, std::size_t index) {
  for (std::size_t i = 0; i < index; ++i) {
    if (std::hypot(points[i].mark.x_mm - points[index].mark.x_mm,
                   points[i].mark.y_mm - points[index].mark.y_mm) <= kRepeatDistanceMm) {
      return true;
    }
  }
  return false;
}

/// Side of the square that one mark has to itself.
double usual_spacing_mm(const std::vector<PlaceInTurn>& places) {
  const auto [low_a, high_a] = std::minmax_element(
      places.begin(), places.end(), [](const PlaceInTurn& a, const PlaceInTurn& b) {
        return a.across_mm < b.across_mm;
      });
  const auto [low_b, high_b] = std::minmax_element(
      places.begin(), places.end(), [](const PlaceInTurn& a, const PlaceInTurn& b) {
        return a.along_mm < b.along_mm;
      });
  const double area_mm2 =
      (high_a->across_mm - low_a->across_mm) * (high_b->along_mm - low_b->along_mm);
  return std::sqrt(area_mm2 / static_cast<double>(places.size()));
}

}  // namespace

std::optional<VisitOrder> order_from_word(const std::string& word) {
  for (const Word& known : kWords) {
    if (known.word == word) return known.order;
  }
  return std::nullopt;
}

tl::expected<std::vector<int>, std::string> assumed_order(const std::vector<MeasuredPoint>& points,
                                                          VisitOrder order) {
  const bool by_rows = order == VisitOrder::rows || order == VisitOrder::serpentine_rows;
  const bool serpentine =
      order == VisitOrder::serpentine_rows || order == VisitOrder::serpentine_columns;
  std::vector<PlaceInTurn> places;
  std::vector<std::size_t> second_visits;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const model::MarkPoint& mark = points[i].mark;
    if (is_second_visit(points, i)) {
      second_visits.push_back(i);
    } else if (by_rows) {
      places.push_back({i, -mark.y_mm, mark.x_mm});
    } else {
      places.push_back({i, mark.x_mm, -mark.y_mm});
    }
  }
  if (places.empty()) return std::vector<int>();
  std::stable_sort(places.begin(), places.end(), [](const PlaceInTurn& a, const PlaceInTurn& b) {
    return a.across_mm < b.across_mm;
  });
  const double gap_mm = kLineGapShare * usual_spacing_mm(places);
  std::vector<std::vector<PlaceInTurn>> lines(1);
  for (const PlaceInTurn& place : places) {
    if (!lines.back().empty() && place.across_mm - lines.back().back().across_mm > gap_mm)
      lines.emplace_back();
    lines.back().push_back(place);
  }
  const bool is_blurred = std::any_of(lines.begin(), lines.end(), [&](const auto& line) {
    return line.back().across_mm - line.front().across_mm > kWidestLine * gap_mm;
  });
  if (is_blurred || lines.size() < 2 ||
      static_cast<double>(places.size()) < kFewestALine * static_cast<double>(lines.size())) {
    return tl::unexpected(
        fmt::format("marks that stand in {}; these do not", by_rows ? "rows" : "columns"));
  }
  std::vector<int> numbers(points.size());
  int visit = 0;
  for (std::size_t line = 0; line < lines.size(); ++line) {
    std::stable_sort(
        lines[line].begin(), lines[line].end(), [](const PlaceInTurn& a, const PlaceInTurn& b) {
          return a.along_mm < b.along_mm;
        });
    if (serpentine && line % 2 == 1) std::reverse(lines[line].begin(), lines[line].end());
    for (const PlaceInTurn& place : lines[line]) numbers[place.index] = visit++;
  }
  for (const std::size_t index : second_visits) numbers[index] = visit++;
  return numbers;
}

}  // namespace chaintrue::cli
