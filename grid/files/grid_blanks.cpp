// SPDX-License-Identifier: GPL-3.0-or-later
// The part of grid_checks.hpp for lists that are filled in: blank and copied points.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grid/containers.hpp"
#include "grid/files/grid_checks.hpp"

namespace chaintrue::grid::files {
namespace {

/// A tape's or a laser's noise is a tenth of a millimetre and more: two visits agree in both lengths
/// to a hundredth once in a thousand times or less.
bool is_finer_than_noise(const std::vector<StatedPoint>& points) {
  constexpr double kPerMm = 10.0;
  return any_of(points, [](const StatedPoint& point) {
    const double tenths = kPerMm * point.left_mm.value_or(0.0);
    return std::abs(tenths - std::round(tenths)) > 1e-6;  // rounding of a length in tenths
  });
}

}  // namespace

void count_copies_once(std::vector<StatedPoint>& points, PointPlaces& places, Problems& problems) {
  using Digits = std::array<double, 4>;
  if (!is_finer_than_noise(points)) return;
  std::map<Digits, std::size_t> first;
  std::vector<std::size_t> kept;
  std::string example;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const StatedPoint& point = points[i];
    const bool is_read = point.left_mm && point.right_mm && !point.order && !point.is_spoilt;
    if (is_read) {
      const auto [at, is_new] =
          first.emplace(Digits{point.x_mm, point.y_mm, *point.left_mm, *point.right_mm}, i);
      if (!is_new) {
        if (example.empty())
          example = fmt::format("{} is {}", places.of(i, ""), places.of(at->second, ""));
        continue;
      }
    }
    kept.push_back(i);
  }
  if (kept.size() == points.size()) return;
  problems.warn(
      places.all,
      fmt::format("{} of {} points are copies of others, to the last digit of both lengths, and "
                  "count once ({}); a repeated measurement would differ",
                  points.size() - kept.size(),
                  points.size(),
                  example));
  keep_only(kept, points, places.of);
}

namespace {

/// How many points would lie where they were commanded, to the last digit, by rounding alone: on a
/// machine that is nearly right a rule to half a millimetre reads many so. The axes are rounded
/// independently, so of the points with both equal, x alone, y alone and neither, n11 n00 = n10 n01.
double copies_by_rounding(const MeasuredGrid& grid) {
  double x_alone = 0.0;
  double y_alone = 0.0;
  double neither = 0.0;
  for (const MeasuredPoint& point : grid.points) {
    if (!point.commanded) continue;
    const bool x = point.commanded->x_mm == point.mark.x_mm;
    const bool y = point.commanded->y_mm == point.mark.y_mm;
    if (x && !y) ++x_alone;
    if (y && !x) ++y_alone;
    if (!x && !y) ++neither;
  }
  return x_alone * y_alone / std::max(neither, 1.0);
}

}  // namespace

void warn_of_copies(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  std::vector<std::string> copies;
  for (std::size_t i = 0; i < grid.points.size(); ++i) {
    const MeasuredPoint& point = grid.points[i];
    if (!point.commanded || point.commanded->x_mm != point.mark.x_mm ||
        point.commanded->y_mm != point.mark.y_mm)
      continue;
    copies.push_back(fmt::format("{}", point.order.value_or(static_cast<int>(i) + 1)));
  }
  // One in a hundred sound lists of such readings has more.
  const double by_rounding = copies_by_rounding(grid);
  if (static_cast<double>(copies.size()) <= by_rounding + 2.33 * std::sqrt(by_rounding)) return;
  problems.warn(places.all,
                fmt::format("{} are exactly where they were commanded, to the last digit. Were "
                            "they measured? If not, leave x_mm and y_mm blank",
                            how_many(copies, grid.points.size(), "points")));
}

}  // namespace chaintrue::grid::files
