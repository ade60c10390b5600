// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/planning/measurement_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/fit.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/precondition.hpp"
#include "grid/raster.hpp"
#include "grid/synthetic/generator.hpp"
#include "interp/planner_nodes.hpp"

namespace chaintrue::grid {
namespace {

/// Errors of real machines after a good calibration (root mean square 0.2 to 0.5 mm on the optical
/// scans of tests/accuracy/real_scans_test.cpp).
constexpr double kDisturbanceMm = 0.5;
/// Replaces exactly known noise: a plan's readings must not be assumed noise-free.
constexpr double kCertainDof = 1e6;
/// Cells of the raster on which the largest expected error is searched.
constexpr int kRasterColumns = 48;
constexpr int kRasterRows = 24;
/// Mirror images differ by rounding, less than this; the first one is kept.
constexpr double kWorse = 1.0 + 1e-6;

/// The map that simulated readings at the marks would give.
tl::expected<CompensationMap, PlanFailure> planned_map(const Machine& machine,
                                                  const PlanRequest& request,
                                                  const std::vector<MarkPoint>& marks) {
  const ReadingModel model(machine);
  MeasuredGrid grid;
  grid.name = "plan";
  grid.machine = machine;
  grid.noise = StatedNoise{request.noise.length_mm, request.noise.position_mm, kCertainDof};
  for (const MarkPoint& mark : marks) {
    const auto reading = model.at(identity_placement(mark));
    if (!reading) {
      return failed(PlanReason::unreachable,
                    fmt::format("the machine cannot measure at ({:.0f}, {:.0f}): {}. A wider "
                                "margin leaves such places out",
                                mark.x_mm, mark.y_mm, reading.error().sentence()));
    }
    ChainLengths lengths = reading->lengths;
    const ChainLengths disturbance = synthetic::unmodelled(identity_placement(mark));
    for (const Side side : kSides) lengths[side] += kDisturbanceMm * disturbance[side];
    grid.points.push_back({mark, lengths, std::nullopt, std::nullopt});
  }
  auto map = fit(grid);
  if (!map) return failed(PlanReason::no_map, map.error().sentence());
  return *std::move(map);
}

/// The cell of the raster with the largest expected error where a mark is allowed.
std::optional<MarkPoint> worst_free(const CompensationMap& map, const Bed& bed, double margin_mm,
                                    const std::vector<MarkPoint>& marks) {
  const interp::Rectangle allowed = area_of(bed, -margin_mm);
  const auto errors = expected_error_mm(map, bed, kRasterColumns, kRasterRows);
  std::vector<MarkPoint> places =
      raster(area_of(bed), kRasterColumns, kRasterRows, RasterOf::cells);
  for (MarkPoint& place : places) {
    place = {std::clamp(place.x_mm, allowed.x_min, allowed.x_max),
             std::clamp(place.y_mm, allowed.y_min, allowed.y_max)};
  }
  places = whole_mm(std::move(places));
  std::optional<MarkPoint> worst;
  double largest = 0.0;
  for (const auto i : each_index(errors)) {
    const MarkPoint& place = places[i];
    // A point nearer than this to another one adds little information.
    const bool taken = any_of(marks, [&](const MarkPoint& mark) {
      return distance_mm(mark, place) <= 2.0 * kRepeatDistanceMm;
    });
    if (taken || errors[i] <= kWorse * largest) continue;
    largest = errors[i];
    worst = place;
  }
  return worst;
}

/// Rows from the bottom, every other one from right to left; an extra point belongs to the nearest
/// row.
void walk(std::vector<MarkPoint>& marks, const std::vector<double>& rows) {
  const auto row_of = [&rows](const MarkPoint& mark) {
    const auto nearest =
        min_element(rows, ascending([&](double row) { return std::abs(row - mark.y_mm); }));
    return nearest - rows.begin();
  };
  sort(marks, [&](const MarkPoint& a, const MarkPoint& b) {
    const auto row_a = row_of(a);
    const auto row_b = row_of(b);
    if (row_a != row_b) return row_a < row_b;
    if (a.x_mm != b.x_mm) return (a.x_mm < b.x_mm) == (row_a % 2 == 0);
    return a.y_mm < b.y_mm;
  });
}

}  // namespace

std::vector<double> expected_error_mm(const CompensationMap& map, const Bed& bed, int columns,
                                      int rows) {
  std::vector<double> errors;
  for (const MarkPoint& mark : raster(area_of(bed), columns, rows, RasterOf::cells)) {
    const auto answer = map.query(mark);
    errors.push_back(answer ? answer->tool_sigma_mm : -1.0);
  }
  return errors;
}

tl::expected<MeasurementPlan, PlanFailure> plan_measurement(const Machine& machine,
                                                            const PlanRequest& request) {
  const Bed& bed = machine.bed;
  const double width = bed.width_mm - 2.0 * request.margin_mm;
  const double height = bed.height_mm - 2.0 * request.margin_mm;
  if (request.points < kFewestPlanned || request.points > kMostPlanned ||
      !(width >= kLeastPlannedSideMm) || !(height >= kLeastPlannedSideMm)) {
    throw precondition(
        "a plan of {} points on {} x {} mm, {} mm from its edges: {} to {} points on "
        "at least {} x {} mm are possible",
        request.points, bed.width_mm, bed.height_mm, request.margin_mm, kFewestPlanned,
        kMostPlanned, kLeastPlannedSideMm, kLeastPlannedSideMm);
  }
  const interp::GridShape shape = interp::grid_shape(width, height, request.points);
  const auto x = interp::chebyshev_lobatto(-0.5 * width, 0.5 * width, shape.columns);
  const auto y = interp::chebyshev_lobatto(-0.5 * height, 0.5 * height, shape.rows);
  std::vector<MarkPoint> marks;
  for (double row : y) {
    for (double column : x) marks.push_back({column, row});
  }
  marks = whole_mm(std::move(marks));
  auto map = planned_map(machine, request, marks);
  while (map && marks.size() < as_size(request.points)) {
    const auto next = worst_free(*map, bed, request.margin_mm, marks);
    if (!next) break;
    marks.push_back(*next);
    map = planned_map(machine, request, marks);
  }
  if (!map) return failed(map);
  walk(marks, y);
  const int extra = as_int(marks.size()) - shape.columns * shape.rows;
  return MeasurementPlan{std::move(marks), shape.columns, shape.rows, extra, *std::move(map)};
}

Indices with_second_visits(std::size_t marks, std::size_t second) {
  if (3 * second > marks) {
    throw std::invalid_argument(fmt::format(
        "{} second visits of {} marks: three marks are needed for each", second, marks));
  }
  Indices visits;
  std::size_t made = 0;  // second visits so far
  for (const std::size_t mark : each_below(marks)) {
    visits.push_back(mark);
    // The last of them is the first mark's, after all others.
    if (made + 1 >= second || (mark + 1) * second < (made + 1) * marks) continue;
    visits.push_back(made * marks / second + 1);
    ++made;
  }
  if (second > 0) visits.push_back(0);
  return visits;
}

}  // namespace chaintrue::grid
