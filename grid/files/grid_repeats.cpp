// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of points measured twice.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/files/grid_checks.hpp"
#include "interp/eigen.hpp"
#include "model/kinematics.hpp"

namespace chaintrue::grid::files {
namespace {

/// Four standard deviations: in a grid of a hundred comparisons one false warning in 150 grids.
constexpr double kSigmas = 4.0;
constexpr std::size_t kMostWarnings = 20;

/// The residual of a reading from the machine model's prediction for its position.
struct Compared {
  std::size_t index;
  MarkPoint mark;
  Vector2d off_mm;
};

/// The reference for a reading, and how far the residual may change from one point to a near one.
struct Comparison {
  std::array<const char*, 2> names;
  double sigma_mm;
  double change_per_mm;
  std::vector<Compared> readings;
};

/// Errors of taped motors, of a sheet placed by hand and of the model itself change the predicted
/// difference between two points by this share.
double share_unknown_to_model(const MeasuredGrid& grid) {
  constexpr double kMachineAsTaped = 0.01;
  constexpr double kReachMm = 1000.0;
  if (!grid.sheet) return kMachineAsTaped;
  return kMachineAsTaped + grid.sheet->shift_mm / kReachMm + grid.sheet->rotation_mrad / 1000.0;
}

Comparison compare_lengths(const MeasuredGrid& grid, const StatedNoise& noise) {
  // A chain grows by at most the tool's distance, plus 2 % for sag and stretch.
  constexpr double kWithoutModel = 1.02;
  Comparison lengths{
      {"left", "right"}, std::hypot(noise.length_mm, noise.position_mm), kWithoutModel, {}};
  std::unique_ptr<const model::Kinematics> kinematics;
  if (grid.machine && problems_of(*grid.machine).empty()) {
    kinematics = make_kinematics(equilibrium_parameters(*grid.machine), Model::elastic);
    lengths.change_per_mm = share_unknown_to_model(grid);
  }
  for (const auto i : each_index(grid.points)) {
    const MeasuredPoint& point = grid.points[i];
    if (!point.lengths) continue;
    Compared reading{i, point.mark, {point.lengths->left_mm, point.lengths->right_mm}};
    if (kinematics) {
      const auto pose = kinematics->inverse(identity_placement(point.mark));
      if (!pose) continue;
      reading.off_mm -= Vector2d(pose->lengths.left_mm, pose->lengths.right_mm);
    }
    lengths.readings.push_back(reading);
  }
  return lengths;
}

Comparison compare_commands(const MeasuredGrid& grid, const StatedNoise& noise) {
  // A machine's error in x and y changes by a few mm over the bed: 0.05 is many times that.
  constexpr double kErrorPerMm = 0.05;
  Comparison errors{{"x", "y"}, noise.position_mm, kErrorPerMm, {}};
  for (const auto i : each_index(grid.points)) {
    const MeasuredPoint& point = grid.points[i];
    if (!point.commanded) continue;
    errors.readings.push_back(
        {i,
         point.mark,
         {point.commanded->x_mm - point.mark.x_mm, point.commanded->y_mm - point.mark.y_mm}});
  }
  return errors;
}

std::string difference_in_words(double mm) {
  constexpr double kMetreMm = 1000.0;
  return mm < kMetreMm ? fmt::format("{:.2f} mm", mm) : fmt::format("{:.1f} m", mm / kMetreMm);
}

void warn_of_pair(const Comparison& comparison, const Compared& a, const Compared& b,
                  const PointPlaces& places, Problems& problems) {
  const double apart_mm = std::hypot(a.mark.x_mm - b.mark.x_mm, a.mark.y_mm - b.mark.y_mm);
  const double allowed_mm =
      kSigmas * std::sqrt(2.0) * comparison.sigma_mm + comparison.change_per_mm * apart_mm;
  std::size_t worse = 0;
  const double most_mm = (a.off_mm - b.off_mm).cwiseAbs().maxCoeff(&worse);
  if (apart_mm > kRepeatDistanceMm || most_mm <= allowed_mm) return;
  // A point that was already reported disagrees with everything.
  const auto is_asked_about = [&](std::size_t row) {
    const auto& warnings = problems.warnings();
    return any_of(warnings, [&](const Warning& warning) {
      return warning.place == places.of(row, "") && warning.sentence.rfind("Mark", 0) == 0;
    });
  };
  if (is_asked_about(a.index) || is_asked_about(b.index)) return;
  problems.warn(places.of(b.index, ""),
                "this mark was also measured at {}, and the two readings differ by {} ({}); at "
                "most {:.1f} mm is normal{}. Is a digit or a minus wrong in one of them?",
                places.of(a.index, ""), difference_in_words(most_mm), comparison.names[worse],
                allowed_mm, apart_mm < 0.5 ? "" : fmt::format(" {:.0f} mm apart", apart_mm));
}

void warn_of_pairs(Comparison comparison, const PointPlaces& places, Problems& problems) {
  auto& readings = comparison.readings;
  stable_sort(readings,
              [](const Compared& a, const Compared& b) { return a.mark.x_mm < b.mark.x_mm; });
  const std::size_t warnings_before = problems.warnings().size();
  for (const auto i : each_index(readings)) {
    for (std::size_t j = i + 1; j < readings.size(); ++j) {
      if (readings[j].mark.x_mm - readings[i].mark.x_mm > kRepeatDistanceMm) break;
      if (problems.warnings().size() - warnings_before == kMostWarnings) {
        problems.warn(places.all, "more points disagree with their repeats; these are the first");
        return;
      }
      const auto& [first, second] =
          std::minmax(readings[i], readings[j],
                      [](const Compared& a, const Compared& b) { return a.index < b.index; });
      warn_of_pair(comparison, first, second, places, problems);
    }
  }
}

}  // namespace

void warn_of_repeats_that_disagree(const MeasuredGrid& grid, const PointPlaces& places,
                                   Problems& problems) {
  const StatedNoise noise = grid.noise.value_or(StatedNoise{});
  warn_of_pairs(compare_lengths(grid, noise), places, problems);
  warn_of_pairs(compare_commands(grid, noise), places, problems);
}

}  // namespace chaintrue::grid::files
