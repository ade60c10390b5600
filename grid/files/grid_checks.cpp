// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/grid_checks.hpp"

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "grid/containers.hpp"
#include "grid/input_checks/number_checks.hpp"
#include "grid/input_checks/point_checks.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::files {

namespace {

/// No hanging router has lengths or a bed below this in mm; in inches all are below it.
constexpr double kLongestInInches = 250.0;

/// The gradients of planes fitted to the lengths of the left and of the right chain, length per mm of
/// x and of y; empty if fewer than three points have lengths or they do not span an area.
std::optional<PerSide<Vector2d>> slopes_of(const std::vector<MeasuredPoint>& points) {
  std::vector<Eigen::Vector4d> rows;
  for (const MeasuredPoint& point : points) {
    if (point.lengths)
      rows.emplace_back(point.mark.x_mm, point.mark.y_mm, point.lengths->left_mm,
                        point.lengths->right_mm);
  }
  if (rows.size() < 3) return std::nullopt;
  MatrixXd all = Eigen::Map<const MatrixXd>(rows.front().data(), 4, as_index(rows.size()));
  all.colwise() -= VectorXd(all.rowwise().mean());
  const Eigen::Matrix4d products = all * all.transpose();
  const Matrix2d spread = products.topLeftCorner<2, 2>();
  constexpr double kThinnest = 1e-4;  // width to length, squared: a 1 : 100 strip spans no plane
  if (spread.determinant() <= kThinnest * spread.trace() * spread.trace()) return std::nullopt;
  const Matrix2d slope = spread.inverse() * products.topRightCorner<2, 2>();
  return PerSide<Vector2d>{slope.col(0), slope.col(1)};
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
constexpr double kUnitUnder = 5.0;
constexpr double kUnitOver = 0.2;
/// Between 7 to 10 times, centimetres, and 18 to 25 times, inches.
constexpr double kFewestInches = 13.0;
const char* unit_of(double factor) { return factor < kFewestInches ? "centimetres" : "inches"; }

/// The largest distance of a mark from the line that fits all of them best.
double width_across_best_line(const std::vector<MeasuredPoint>& points) {
  Matrix2Xd places(2, as_index(points.size()));
  for (const auto i : each_index(points))
    places.col(as_index(i)) << points[i].mark.x_mm, points[i].mark.y_mm;
  places.colwise() -= Vector2d(places.rowwise().mean());
  const linear::SymmetricEigen spread(MatrixXd(places * places.transpose()));
  return (spread.eigenvectors().col(0).transpose() * places).cwiseAbs().maxCoeff();
}

/// Reports to `problems`.
struct GridChecks {
  const MeasuredGrid& grid;
  const PointPlaces& places;
  Problems& problems;

  /// Reports another unit than mm; true if found. For grids without a machine.
  bool check_unit(const std::optional<PerSide<Vector2d>>& slopes) const {
    const Extent extent = extent_of(grid);
    if (extent.length > 0.0 && extent.length < kLongestInInches &&
        extent.coordinate < kLongestInInches) {
      // Chains reach 2.5 to 3.7 m: 100 to 146 inches, or 250 centimetres and more.
      constexpr double kLongestChainInches = 150.0;
      const auto& [word, mm] =
          input_checks::kWrittenUnits[extent.length < kLongestChainInches ? 0 : 1];
      problems.explain(
          places.all, ProblemKind::other_unit,
          fmt::format(
              "These look like {}: multiply all of them by {:g}{} (coordinates reach {:.6g}, "
              "lengths {:.6g}).",
              word, mm,
              mm == input_checks::kMmPerInch ? input_checks::or_say_inches(places.written) : "",
              extent.coordinate, extent.length));
      return true;
    }
    if (!slopes) return false;
    const auto [least, most] = std::minmax({slopes->left.norm(), slopes->right.norm()});
    const bool are_marks = least > kUnitUnder;
    if (!are_marks && most >= kUnitOver) return false;
    const double steepness = 0.5 * (least + most);
    problems.explain(
        places.all, ProblemKind::other_unit,
        fmt::format(
            "{} look like {}, {} like mm (lengths that change by {:.3g} for each 1 of x_mm, "
            "y_mm, where 1 is usual).",
            are_marks ? "x_mm and y_mm" : "the lengths",
            unit_of(are_marks ? steepness : 1.0 / steepness),
            are_marks ? "the lengths" : "x_mm and y_mm", steepness));
    return true;
  }

  /// Lengths of a machine whose motors are above change with x in opposite ways and decrease towards
  /// the motors. True if x and y are exchanged, which is reported.
  bool check_axes(const PerSide<Vector2d>& slopes) const {
    constexpr double kClearly = 0.3;
    const auto& [left, right] = slopes;
    if (left.y() > kClearly && right.y() < -kClearly && left.x() < 0.0 && right.x() < 0.0) {
      problems.explain(places.all, ProblemKind::axes,
                       "the two columns look swapped: left lengths grow and right ones shrink "
                       "with y_mm. x_mm counts to the right, y_mm up the sheet.");
      return true;
    }
    return false;
  }

  void check_sides(const PerSide<Vector2d>& slopes) const {
    const auto& [left, right] = slopes;
    if (left.x() < 0.0 && right.x() > 0.0) {
      problems.explain(
          places.all, ProblemKind::sides_swapped,
          "the columns left_mm and right_mm look swapped: left lengths shrink and right "
          "ones grow towards +x.");
    }
    constexpr double kClearly = 0.1;
    if (left.y() > kClearly && right.y() > kClearly) {
      problems.explain(
          places.all, ProblemKind::axes,
          "y_mm looks counted downwards: both chains grow towards +y, where the motors "
          "are. y_mm counts up the sheet.");
    }
  }

  /// Commands and marks both in inches are consistent with each other; only the bed shows that they
  /// cover a twenty-fifth of it. True if so.
  bool warn_of_a_tiny_area() const {
    if (!grid.machine) return false;
    double half_width_mm = 0.0;
    double half_height_mm = 0.0;
    for (const MeasuredPoint& point : grid.points) {
      half_width_mm = std::max(half_width_mm, std::abs(point.mark.x_mm));
      half_height_mm = std::max(half_height_mm, std::abs(point.mark.y_mm));
    }
    const Bed& bed = grid.machine->bed;
    if (2.0 * half_width_mm * input_checks::kMmPerInch > bed.width_mm ||
        2.0 * half_height_mm * input_checks::kMmPerInch > bed.height_mm)
      return false;
    problems.warn(
        places.all,
        "all points are within {:.4g} x {:.4g} mm of a bed of {} x {} mm; are they in inches?",
        2.0 * half_width_mm, 2.0 * half_height_mm, bed.width_mm, bed.height_mm);
    return true;
  }

  /// Errors of the whole file, and of rows. True if no further check is useful.
  bool check_entries() const {
    if (!grid.machine) {
      const auto slopes = slopes_of(grid.points);
      if (check_unit(slopes)) return true;
      if (!slopes) return false;
      if (check_axes(*slopes)) return true;
      check_sides(*slopes);
      return false;
    }
    const input_checks::Findings found = input_checks::check_points(grid, places.written);
    if (found.whole && found.whole->is_doubtful) {
      problems.warn(places.all, found.whole->sentence(), found.whole->kind);
    } else if (found.whole) {
      problems.explain(found.whole->from_row ? places.of(*found.whole->from_row, "") : places.all,
                       found.whole->kind, found.whole->sentence());
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
};

}  // namespace

void check_points_together(const MeasuredGrid& grid, std::size_t fewest_points,
                           const PointPlaces& places, Problems& problems) {
  const std::size_t count = grid.points.size();
  if (count < fewest_points) {
    problems.explain(places.all, ProblemKind::too_few,
                     fmt::format("{} filled in, and at least {} are needed: measure {} more.",
                                 count == 0   ? "No point is"
                                 : count == 1 ? "Only 1 point is"
                                              : fmt::format("Only {} points are", count),
                                 fewest_points, fewest_points - count));
  }
  const bool has_commands = any_of(grid.points, &MeasuredPoint::commanded);
  if (has_commands && !grid.machine) {
    problems.add(places.all, "commanded positions, but no machine", ProblemKind::missing,
                 "a machine with the controller that received the commands (\"machine\", "
                 "\"machine_file\" or --machine)");
  }
  const GridChecks checks{grid, places, problems};
  if (count == 0 || checks.check_entries()) return;
  const bool is_tiny = count >= kFewestPoints && checks.warn_of_a_tiny_area();
  if (fewest_points < kFewestPoints || count < fewest_points) return;
  if (const double width = width_across_best_line(grid.points); width < kRepeatDistanceMm) {
    problems.add(places.all, fmt::format("points within {:.3g} mm of one line", width),
                 ProblemKind::on_a_line,
                 std::string("points that span an area, which a map of the bed needs") +
                     (is_tiny ? "; are they in inches?" : ""));
  }
}

namespace {

/// A tape's or a laser's noise is a tenth of a millimetre and more: two visits agree in both lengths
/// to a hundredth once in a thousand times or less.
bool is_finer_than_noise(const std::vector<EnteredPoint>& points) {
  constexpr double kPerMm = 10.0;
  return any_of(points, [](const EnteredPoint& entered) {
    const double tenths = kPerMm * entered.point.lengths.value_or(ChainLengths{}).left_mm;
    return std::abs(tenths - std::round(tenths)) > 1e-6;  // rounding of a length in tenths
  });
}

}  // namespace

void count_copies_once(std::vector<EnteredPoint>& points, PointPlaces& places, Problems& problems) {
  using Digits = std::array<double, 4>;
  if (!is_finer_than_noise(points)) return;
  std::map<Digits, std::size_t> first;
  Indices kept;
  std::string example;
  for (const auto i : each_index(points)) {
    const auto& [mark, lengths, commanded, order] = points[i].point;
    if (lengths && !order && !points[i].is_spoilt) {
      const auto [at, is_new] =
          first.emplace(Digits{mark.x_mm, mark.y_mm, lengths->left_mm, lengths->right_mm}, i);
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
                "{} of {} points are copies of others, to the last digit of both "
                "lengths, and count once ({}); a repeated measurement would differ",
                points.size() - kept.size(), points.size(), example);
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
  Words copies;
  for (const auto i : each_index(grid.points)) {
    const MeasuredPoint& point = grid.points[i];
    if (!point.commanded || point.commanded->x_mm != point.mark.x_mm ||
        point.commanded->y_mm != point.mark.y_mm)
      continue;
    copies.push_back(fmt::format("{}", point.order.value_or(as_int(i) + 1)));
  }
  // One in a hundred sound lists of such readings has more.
  const double by_rounding = copies_by_rounding(grid);
  if (as_double(copies.size()) <= by_rounding + 2.33 * std::sqrt(by_rounding)) return;
  problems.warn(places.all,
                "{} are exactly where they were commanded, to the last digit. Were "
                "they measured? If not, leave x_mm and y_mm blank",
                how_many(copies, grid.points.size(), "points"));
}

}  // namespace chaintrue::grid::files
