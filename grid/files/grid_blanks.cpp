// SPDX-License-Identifier: GPL-3.0-or-later
// The part of grid_checks.hpp about lists that are filled in: what is left blank, what is copied.
#include <fmt/format.h>

#include "grid/files/grid_checks.hpp"

namespace chaintrue::grid::files {

void leave_out_blanks(std::vector<StatedPoint>& points, PointPlaces& places, Problems& problems) {
  std::vector<std::size_t> kept;
  std::vector<std::string> blank;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].is_blank) {
      blank.push_back(fmt::format("{}", points[i].order.value_or(static_cast<int>(i) + 1)));
    } else {
      kept.push_back(i);
    }
  }
  if (blank.empty()) return;
  if (kept.empty()) {
    problems.add(places.all,
                 fmt::format("{} points, all left blank", blank.size()),
                 "what was read at them, written into the empty columns");
    problems.throw_if_any();
  }
  problems.warn(places.all,
                fmt::format("{} of {} points are left blank and left out: {}",
                            blank.size(),
                            points.size(),
                            joined(blank)));
  std::vector<StatedPoint> others;
  for (const std::size_t i : kept) others.push_back(points[i]);
  points = std::move(others);
  places.of = [kept, of = places.of](std::size_t index, std::string_view field) {
    return of(kept[index], field);
  };
}

void warn_of_copies(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  std::vector<std::string> copies;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const MeasuredPoint& point = grid.points[i];
    if (!point.commanded || point.commanded->x_mm != point.mark.x_mm ||
        point.commanded->y_mm != point.mark.y_mm)
      continue;
    copies.push_back(fmt::format("{}", point.order.value_or(static_cast<int>(i) + 1)));
  }
  if (copies.empty()) return;
  problems.warn(
      places.all,
      fmt::format(
          "{} lie exactly where they were commanded, to the last digit. Were "
          "they measured? Leave x_mm and y_mm blank where not",
          copies.size() == grid.points.size()
              ? fmt::format("all {} points", copies.size())
              : fmt::format(
                    "{} of {} points ({})", copies.size(), grid.points.size(), joined(copies))));
}

}  // namespace chaintrue::grid::files
