// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/grid_checks.hpp"

#include <fmt/format.h>
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grid/containers.hpp"
#include "grid/input_checks/number_checks.hpp"
#include "grid/input_checks/point_checks.hpp"

namespace chaintrue::grid::files {

namespace {

using Getter = std::function<std::optional<double>(const MeasuredPoint&)>;

/// No hanging router has lengths or a bed below this in mm; in inches all are below it.
constexpr double kLongestInInches = 250.0;

void check_parts(const StatedPoint& point, const std::string& place, Problems& problems) {
  const bool any_length = point.left_mm || point.right_mm;
  const bool any_command = point.commanded_x_mm || point.commanded_y_mm;
  const bool lengths = point.left_mm && point.right_mm;
  const bool command = point.commanded_x_mm && point.commanded_y_mm;
  if (any_length && any_command) {
    problems.add(place,
                 "both lengths and a command",
                 "either left_mm and right_mm, or commanded_x_mm and commanded_y_mm",
                 ProblemKind::contradiction);
  } else if (any_length && !lengths) {
    problems.add(place,
                 point.left_mm ? "left_mm without right_mm" : "right_mm without left_mm",
                 "both lengths",
                 ProblemKind::missing);
  } else if (any_command && !command) {
    problems.add(place,
                 point.commanded_x_mm ? "commanded_x_mm without commanded_y_mm"
                                      : "commanded_y_mm without commanded_x_mm",
                 "both coordinates of the command",
                 ProblemKind::missing);
  } else if (!any_length && !any_command) {
    problems.add(place,
                 "neither lengths nor a command",
                 "left_mm and right_mm, or commanded_x_mm and commanded_y_mm",
                 ProblemKind::missing);
  }
}

/// The gradient of a plane fitted to some value of the points, value per mm of x and of y.
struct Slope {
  double per_x = 0.0;
  double per_y = 0.0;
  [[nodiscard]] double steepness() const { return std::hypot(per_x, per_y); }
};

/// Empty if fewer than three points have the value or they do not span an area.
std::optional<Slope> slope_of(const std::vector<MeasuredPoint>& points, const Getter& value_of) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const MeasuredPoint& point : points) {
    if (const auto value = value_of(point)) {
      sum += Eigen::Vector3d(point.mark.x_mm, point.mark.y_mm, *value);
      count += 1.0;
    }
  }
  if (count < 3.0) return std::nullopt;
  const Eigen::Vector3d mean = sum / count;
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  Eigen::Vector2d together = Eigen::Vector2d::Zero();
  for (const MeasuredPoint& point : points) {
    if (const auto value = value_of(point)) {
      const Eigen::Vector2d place(point.mark.x_mm - mean.x(), point.mark.y_mm - mean.y());
      spread += place * place.transpose();
      together += place * (*value - mean.z());
    }
  }
  constexpr double kThinnest = 1e-4;  // width to length, squared: a 1 : 100 strip spans no plane
  if (spread.determinant() <= kThinnest * spread.trace() * spread.trace()) return std::nullopt;
  const Eigen::Vector2d slope = Eigen::LDLT<Eigen::Matrix2d>(spread).solve(together);
  return Slope{slope.x(), slope.y()};
}

std::optional<double> left_of(const MeasuredPoint& point) {
  return point.lengths ? std::optional(point.lengths->left_mm) : std::nullopt;
}
std::optional<double> right_of(const MeasuredPoint& point) {
  return point.lengths ? std::optional(point.lengths->right_mm) : std::nullopt;
}
/// The largest |x|, |y| and length of all points.
struct Extent {
  double coordinate = 0.0;
  double length = 0.0;
};

Extent extent_of(const MeasuredGrid& grid) {
  Extent extent;
  for (const MeasuredPoint& point : grid.points) {
    extent.coordinate =
        std::max({extent.coordinate, std::abs(point.mark.x_mm), std::abs(point.mark.y_mm)});
    if (point.lengths) {
      extent.length = std::max({extent.length, point.lengths->left_mm, point.lengths->right_mm});
    }
  }
  return extent;
}

/// A chain grows by at most a millimetre for each that the tool moves, and over a bed by 0.7 mm or
/// more; 25.4 times that or the 25.4th part of it is a change of unit. The limits are half-way, in
/// ratios.
bool is_unit_under(double steepness) { return steepness > 5.0; }
bool is_unit_over(double steepness) { return steepness < 0.2; }
/// Between 7 to 10 times, centimetres, and 18 to 25 times, inches.
constexpr double kFewestInches = 13.0;
const char* unit_of(double factor) { return factor < kFewestInches ? "centimetres" : "inches"; }

/// Reports another unit than mm; true if found. For grids without a machine.
bool check_unit(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  const Extent extent = extent_of(grid);
  if (extent.length > 0.0 && extent.length < kLongestInInches &&
      extent.coordinate < kLongestInInches) {
    // Chains reach 2.5 to 3.7 m: 100 to 146 inches, or 250 centimetres and more.
    constexpr double kLongestChainInches = 150.0;
    problems.explain(
        places.all,
        ProblemKind::other_unit,
        fmt::format(
            "These look like {}: multiply all of them by {}{} (coordinates reach {:.6g}, lengths "
            "{:.6g}).",
            extent.length < kLongestChainInches ? "inches" : "centimetres",
            extent.length < kLongestChainInches ? "25.4" : "10",
            extent.length < kLongestChainInches ? input_checks::or_say_inches(places.written) : "",
            extent.coordinate,
            extent.length));
    return true;
  }
  const auto first = slope_of(grid.points, left_of);
  const auto second = slope_of(grid.points, right_of);
  if (!first || !second) return false;
  const double steepness = 0.5 * (first->steepness() + second->steepness());
  const std::string found =
      fmt::format("lengths that change by {:.3g} for each 1 of x_mm, y_mm", steepness);
  if (is_unit_under(first->steepness()) && is_unit_under(second->steepness())) {
    problems.explain(places.all,
                     ProblemKind::other_unit,
                     fmt::format("x_mm and y_mm look like {}, the lengths like mm ({}, where 1 is "
                                 "usual).",
                                 unit_of(steepness),
                                 found));
    return true;
  }
  if (is_unit_over(first->steepness()) && is_unit_over(second->steepness())) {
    problems.explain(places.all,
                     ProblemKind::other_unit,
                     fmt::format("the lengths look like {}, x_mm and y_mm like mm ({}, where 1 is "
                                 "usual).",
                                 unit_of(1.0 / steepness),
                                 found));
    return true;
  }
  return false;
}

/// Lengths of a machine whose motors are above change with x in opposite ways and decrease towards
/// the motors. True if x and y are exchanged, which is reported.
bool check_axes(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  constexpr double kClearly = 0.3;
  const auto left = slope_of(grid.points, left_of);
  const auto right = slope_of(grid.points, right_of);
  if (left && right && left->per_y > kClearly && right->per_y < -kClearly && left->per_x < 0.0 &&
      right->per_x < 0.0) {
    problems.explain(places.all,
                     ProblemKind::axes,
                     "the two columns look swapped: left lengths grow and right ones shrink "
                     "with y_mm. x_mm counts to the right, y_mm up the sheet.");
    return true;
  }
  return false;
}

void check_sides(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  const auto left = slope_of(grid.points, left_of);
  const auto right = slope_of(grid.points, right_of);
  if (left && right) {
    if (left->per_x < 0.0 && right->per_x > 0.0) {
      problems.explain(
          places.all,
          ProblemKind::sides_swapped,
          "the columns left_mm and right_mm look swapped: left lengths shrink and right "
          "ones grow towards +x.");
    }
    constexpr double kClearly = 0.1;
    if (left->per_y > kClearly && right->per_y > kClearly) {
      problems.explain(
          places.all,
          ProblemKind::axes,
          "y_mm looks counted downwards: both chains grow towards +y, where the motors "
          "are. y_mm counts up the sheet.");
    }
  }
}

/// The largest distance of a mark from the line that fits all of them best.
double width_across_best_line(const std::vector<MeasuredPoint>& points) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const MeasuredPoint& point : points)
    mean += Eigen::Vector2d(point.mark.x_mm, point.mark.y_mm);
  mean /= static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const MeasuredPoint& point : points) {
    const Eigen::Vector2d place = Eigen::Vector2d(point.mark.x_mm, point.mark.y_mm) - mean;
    spread += place * place.transpose();
  }
  const double angle = 0.5 * std::atan2(2.0 * spread(0, 1), spread(0, 0) - spread(1, 1));
  const Eigen::Vector2d across(-std::sin(angle), std::cos(angle));
  double widest = 0.0;
  for (const MeasuredPoint& point : points) {
    const Eigen::Vector2d place = Eigen::Vector2d(point.mark.x_mm, point.mark.y_mm) - mean;
    widest = std::max(widest, std::abs(across.dot(place)));
  }
  return widest;
}

/// Commands and marks both in inches are consistent with each other; only the bed shows that they
/// cover a twenty-fifth of it. True if so.
bool warn_of_a_tiny_area(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  if (!grid.machine) return false;
  double half_width_mm = 0.0;
  double half_height_mm = 0.0;
  for (const MeasuredPoint& point : grid.points) {
    half_width_mm = std::max(half_width_mm, std::abs(point.mark.x_mm));
    half_height_mm = std::max(half_height_mm, std::abs(point.mark.y_mm));
  }
  const model::Bed& bed = grid.machine->bed;
  if (2.0 * half_width_mm * input_checks::kMmPerInch > bed.width_mm ||
      2.0 * half_height_mm * input_checks::kMmPerInch > bed.height_mm)
    return false;
  problems.warn(
      places.all,
      fmt::format(
          "all points are within {:.4g} x {:.4g} mm of a bed of {} x {} mm; are they in inches?",
          2.0 * half_width_mm,
          2.0 * half_height_mm,
          bed.width_mm,
          bed.height_mm));
  return true;
}

/// Errors of the whole file, and of rows. True if no further check is useful.
bool check_entries(const MeasuredGrid& grid, const PointPlaces& places, Problems& problems) {
  if (!grid.machine) {
    if (check_unit(grid, places, problems) || check_axes(grid, places, problems)) return true;
    check_sides(grid, places, problems);
    return false;
  }
  const input_checks::Findings found = input_checks::check_points(grid, places.written);
  if (found.whole && found.whole->is_doubtful) {
    problems.warn(places.all, found.whole->sentence(), found.whole->kind);
  } else if (found.whole) {
    problems.explain(found.whole->from_row ? places.of(*found.whole->from_row, "") : places.all,
                     found.whole->kind,
                     found.whole->sentence());
    return true;
  }
  for (const input_checks::RowFinding& row : found.rows) {
    if (row.is_impossible) {
      problems.explain(places.of(row.row, ""), ProblemKind::doubtful_row, row.sentence);
    } else {
      problems.warn(places.of(row.row, ""), row.sentence, ProblemKind::doubtful_row);
    }
  }
  return false;
}

}  // namespace

std::vector<MeasuredPoint> measured_points(const std::vector<StatedPoint>& stated,
                                           const PointPlaces& places,
                                           Problems& problems) {
  std::vector<MeasuredPoint> points;
  std::vector<StatedOrder> orders;
  for (std::size_t i = 0; i < stated.size(); ++i) {
    const StatedPoint& from = stated[i];
    if (!from.is_spoilt) check_parts(from, places.of(i, ""), problems);
    MeasuredPoint point;
    point.mark = {from.x_mm, from.y_mm};
    if (from.left_mm && from.right_mm) point.lengths = {*from.left_mm, *from.right_mm};
    if (from.commanded_x_mm && from.commanded_y_mm) {
      point.commanded = {*from.commanded_x_mm, *from.commanded_y_mm};
    }
    point.order = from.order;
    points.push_back(point);
    orders.push_back({from.order, from.is_spoilt});
  }
  check_orders(orders, places.of, problems);
  return points;
}

void check_points_together(const MeasuredGrid& grid,
                           std::size_t fewest_points,
                           const PointPlaces& places,
                           Problems& problems) {
  const std::size_t count = grid.points.size();
  if (count < fewest_points) {
    problems.explain(places.all,
                     ProblemKind::too_few,
                     fmt::format("{} filled in, and at least {} are needed: measure {} more.",
                                 count == 0   ? "No point is"
                                 : count == 1 ? "Only 1 point is"
                                              : fmt::format("Only {} points are", count),
                                 fewest_points,
                                 fewest_points - count));
  }
  const bool has_commands =
      any_of(grid.points, [](const MeasuredPoint& point) { return point.commanded.has_value(); });
  if (has_commands && !grid.machine) {
    problems.add(places.all,
                 "commanded positions, but no machine",
                 "a machine with the controller that received the commands (\"machine\", "
                 "\"machine_file\" or --machine)",
                 ProblemKind::missing);
  }
  if (count == 0 || check_entries(grid, places, problems)) return;
  const bool is_tiny = count >= kFewestPoints && warn_of_a_tiny_area(grid, places, problems);
  if (fewest_points < kFewestPoints || count < fewest_points) return;
  if (const double width = width_across_best_line(grid.points); width < kRepeatDistanceMm) {
    problems.add(places.all,
                 fmt::format("points within {:.3g} mm of one line", width),
                 std::string("points that span an area, which a map of the bed needs") +
                     (is_tiny ? "; are they in inches?" : ""),
                 ProblemKind::on_a_line);
  }
}

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
  problems.warn(places.all,
                fmt::format("{} of {} points are copies of others, to the last digit of both "
                            "lengths, and count once ({}); a repeated measurement would differ",
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
