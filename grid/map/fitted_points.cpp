// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fitted_points.hpp"

#include <Eigen/LU>

#include "grid/containers.hpp"
#include "grid/estimation/placement_fit.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/raster.hpp"

namespace chaintrue::grid {
namespace {

/// A chain residual (read minus predicted) as an error of the tool: where it landed minus where the
/// model puts it.
Vector2d to_tool(const Matrix2d& mark_jacobian, const Vector2d& chain_mm) {
  return -(mark_jacobian.inverse() * chain_mm);
}

/// On the sheet. The controller uses neither the stated machine nor the catenary; a machine that
/// reaches its commanded places is right.
Vector2d landed_minus_sent(BedPoint commanded, const SheetPlacement& sheet, MarkPoint mark) {
  const BedPoint place = sheet.to_bed(mark);
  return sheet.rotation().transpose() * difference(place, commanded);
}

/// Fits the placement of the sheet under the uncalibrated machine, by weighted least squares on its
/// good points.
SheetPlacement fit_sheet_placement(const std::vector<FittedPoint>& points, const MeasuredGrid& grid,
                                   const observation::PointNoise& noise,
                                   const ReadingModel& stated) {
  std::vector<LengthPoint> good;
  for (const FittedPoint& point : points) {
    if (!point.is_rejected()) good.push_back(point.point);
  }
  const observation::ChainLengthReadings readings =
      chain_length_readings(good, noise, 0.0, grid.sheet);
  return estimation::fit_placement([&](const SheetPlacement& sheet,
                                       estimation::PlacementNormal& sum) {
    const auto line = readings.linearise({stated, sheet}, {.sheet = true});
    if (!line) return false;
    for (const auto i : each_index(good)) {
      const auto row = 2 * as_index(i);
      const auto& commanded = good[i].commanded;
      const Vector2d residual =
          commanded
              ? -line->places[i].by_mark * landed_minus_sent(*commanded, sheet, good[i].mark)
              : Vector2d(readings.measured().segment(row, 2) - line->predicted.segment(row, 2));
      sum.add(residual, line->by_setting.middleRows(row, 2), line->units[i].covariance.inverse());
    }
    return true;
  });
}

/// Where the tool landed minus where the uncalibrated machine puts it: the command, or the position
/// of the lengths; zero if that machine has no pose.
Vector2d error_as_stated(const ReadingModel& model, const SheetPlacement& sheet,
                         const LengthPoint& point) {
  if (point.commanded) return landed_minus_sent(*point.commanded, sheet, point.mark);
  const auto reading = model.at(sheet.to_bed(point.mark));
  if (!reading) return Vector2d::Zero();
  return to_tool(reading->position_jacobian * sheet.rotation(),
                 difference(point.lengths, reading->lengths));
}

}  // namespace

std::vector<FittedPoint> fitted_points(const std::vector<LengthPoint>& points,
                                       const estimation::Estimate& estimate,
                                       std::size_t observation) {
  std::vector<FittedPoint> fitted;
  for (const estimation::UnitEstimate& unit : estimate.units) {
    if (unit.observation != observation) continue;
    fitted.push_back(
        {unit, points[unit.unit], estimate.observations[observation].places[unit.unit].by_mark});
  }
  return fitted;
}

MapAccuracy held_out_accuracy(const std::vector<FittedPoint>& points) {
  std::vector<HeldOutResidual> one;
  std::vector<HeldOutResidual> blocks;
  for (const FittedPoint& point : points) {
    if (point.is_rejected()) continue;
    one.push_back({point.left_out, point.mark_jacobian});
    blocks.push_back({point.left_out_with_group, point.mark_jacobian});
  }
  MapAccuracy accuracy;
  accuracy.leave_one_out = summarise(one);
  accuracy.blocked = summarise(blocks);
  return accuracy;
}

std::vector<MapPoint> map_points(const std::vector<FittedPoint>& points, const MeasuredGrid& grid,
                                 const observation::PointNoise& noise) {
  const ReadingModel stated(*grid.machine);
  const SheetPlacement laid =
      grid.sheet ? fit_sheet_placement(points, grid, noise, stated) : SheetPlacement{};
  std::vector<MapPoint> result;
  for (const FittedPoint& fitted : points) {
    MapPoint point;
    point.mark = fitted.point.mark;
    point.lengths = fitted.point.lengths;
    point.bad = fitted.is_rejected();
    point.distance_sigmas = fitted.distance;
    point.as_stated_mm = error_as_stated(stated, {}, fitted.point);
    point.sheet_placed_mm = error_as_stated(stated, laid, fitted.point);
    point.mapped_mm = to_tool(fitted.mark_jacobian, fitted.residual);
    point.left_out_mm = to_tool(fitted.mark_jacobian, fitted.left_out);
    result.push_back(point);
  }
  return result;
}

DistancesUsed distances_used(const std::vector<FittedDistance>& distances, double tape_sigma_mm) {
  DistancesUsed used;
  used.tape_sigma_mm = tape_sigma_mm;
  std::vector<double> all, good;
  for (const FittedDistance& distance : distances) {
    (distance.rejected ? used.rejected : used.used) += 1;
    all.push_back(distance.left_out_mm);
    if (!distance.rejected) good.push_back(distance.left_out_mm);
  }
  used.left_out_all = summary_of(all);
  used.left_out_good = summary_of(good);
  return used;
}

interp::Rectangle holes_domain(const Bed& bed) {
  constexpr double kMarginMm = 50.0;
  return area_of(bed, kMarginMm);
}

}  // namespace chaintrue::grid
