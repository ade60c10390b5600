// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in the header.
#include "grid/planning/check_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/check_readings.hpp"
#include "grid/planning/distance_choice.hpp"
#include "grid/precondition.hpp"
#include "grid/raster.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "model/chains/chain_changes.hpp"

namespace chaintrue::grid {
namespace {

/// Positions where the map has an answer, row by row from the top left.
std::vector<MarkPoint> places_of(const CompensationMap& map, double margin_mm) {
  interp::Rectangle from_top = area_of(map.machine()->bed, -margin_mm);
  std::swap(from_top.y_min, from_top.y_max);
  std::vector<MarkPoint> places = whole_mm(raster(from_top, 9, 5, RasterOf::nodes));
  std::erase_if(places, [&](const MarkPoint& mark) {
    return map.status(mark) == MapStatus::extrapolated || !map.query(mark);
  });
  return places;
}

class Separation {
 public:
  explicit Separation(const CheckReadings& readings)
      : readings_(readings), covariance_(readings.covariance.dense()) {}

  /// (1), both chains.
  PerSide<double> squared_sigmas(const Indices& points) const {
    Rows rows;
    for (const std::size_t point : points) {
      rows.push_back(2 * as_index(point));
      rows.push_back(rows.back() + 1);
    }
    const auto count = std::ssize(rows);
    MatrixXd shifted = MatrixXd::Zero(count, 2), grown = shifted;
    for (const Index i : each_below(count)) {
      shifted(i, i % 2) = model::kZeroShiftSigmaMm;
      grown(i, i % 2) = model::kPitchGrowthSigma * readings_.lengths_mm[rows[as_size(i)]];
    }
    MatrixXd k = covariance_(rows, rows);
    linear::add_outer(k, 1.0, shifted);
    const MatrixXd white = linear::Cholesky(std::move(k)).half_solve(grown);
    return {white.col(0).squaredNorm(), white.col(1).squaredNorm()};
  }

  /// Harmonic mean of both chains': near the smaller one, and increased by either.
  double together(const Indices& points) const {
    const PerSide<double> answer = squared_sigmas(points);
    return 2.0 / (1.0 / answer.left + 1.0 / answer.right);
  }

 private:
  const CheckReadings& readings_;
  MatrixXd covariance_;
};

/// Exchanges points as long as an exchange is an improvement, from evenly spaced ones.
Indices choose(const Separation& separation, std::size_t places, int points) {
  Indices chosen;
  for (const int i : each_below(points)) {
    chosen.push_back(as_size(i) * (places - 1) / as_size(points - 1));
  }
  const auto value = [&](std::size_t) { return 1.0 / separation.together(chosen); };
  exchange({20, 1e-6}, numbers_below(places), chosen, value(0), value);
  sort(chosen);
  return chosen;
}

void check(const CompensationMap& map, const CheckPlanRequest& request) {
  const bool sound = request.points >= kFewestCheckPoints && request.points <= kMostCheckPoints &&
                     request.length_mm > 0.0 && request.position_mm >= 0.0 &&
                     request.margin_mm >= 0.0;
  const Machine* machine = map.machine();
  const bool fits =
      machine == nullptr ||
      2.0 * request.margin_mm < std::min(machine->bed.width_mm, machine->bed.height_mm);
  if (sound && fits) return;
  throw precondition("a check of {} points, {} mm from the edges, with noise of {} and {} mm",
                     request.points, request.margin_mm, request.length_mm, request.position_mm);
}

/// Readings equal to the map's prediction.
tl::expected<CheckReadings, PlanFailure> readings_at(const CompensationMap& map,
                                                     const std::vector<MarkPoint>& marks,
                                                     const CheckPlanRequest& request) {
  MeasuredGrid grid;
  grid.noise = StatedNoise{request.length_mm, request.position_mm};
  for (const MarkPoint& mark : marks) {
    const auto answer = map.query(mark);
    if (!answer) {
      return failed(PlanReason::unreachable, fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm,
                                                         mark.y_mm, answer.error().sentence()));
    }
    grid.points.push_back({mark, answer->lengths, {}, {}});
  }
  auto readings = check_readings(map, grid);
  if (!readings) {
    return failed(PlanReason::unreachable, readings.error().sentence());
  }
  return *std::move(readings);
}

PlanFailure no_machine() {
  return {PlanFailure::Reason::no_machine,
          "a direct map has no machine: its bed and the effect of a zero are unknown"};
}

PerSide<double> roots(const PerSide<double>& squares) {
  return {std::sqrt(squares.left), std::sqrt(squares.right)};
}

}  // namespace

tl::expected<PerSide<double>, PlanFailure> expected_sigmas(const CompensationMap& map,
                                                           const std::vector<MarkPoint>& marks,
                                                           const CheckPlanRequest& request) {
  if (map.machine() == nullptr) return tl::unexpected(no_machine());
  const auto readings = readings_at(map, marks, request);
  if (!readings) return failed(readings);
  auto all = numbers_below(marks.size());
  return roots(Separation(*readings).squared_sigmas(all));
}

tl::expected<CheckPlan, PlanFailure> plan_check(const CompensationMap& map,
                                                const CheckPlanRequest& request) {
  check(map, request);
  if (map.machine() == nullptr) return tl::unexpected(no_machine());
  const std::vector<MarkPoint> places = places_of(map, request.margin_mm);
  if (places.size() < as_size(request.points)) {
    return failed(PlanReason::too_few_places,
                  fmt::format("the map covers only {} of the places tried", places.size()));
  }
  const auto readings = readings_at(map, places, request);
  if (!readings) return failed(readings);
  const Separation separation(*readings);
  const Indices chosen = choose(separation, places.size(), request.points);
  CheckPlan plan;
  for (const std::size_t k : chosen) plan.marks.push_back(places[k]);
  plan.expected_sigmas = roots(separation.squared_sigmas(chosen));
  return plan;
}

}  // namespace chaintrue::grid
