// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/fitted_points.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <map>

#include "grid/containers.hpp"
#include "grid/estimation/placement_fit.hpp"
#include "grid/map/map_accuracy.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/raster.hpp"
#include "model/calibration/setting.hpp"

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

namespace {

/// Sigmas from which a tape's zero offset is reported: one sound file in 370 exceeds it.
constexpr double kTapeZeroSigmas = 3.0;

void note_rejected(const MeasuredHoles& set, const FittedDistances& fit,
                   std::vector<std::string>& notes) {
  std::map<std::size_t, int> at_hole;
  for (const auto k : each_index(fit.distances)) {
    const FittedDistance& distance = fit.distances[k];
    if (!distance.rejected) continue;
    const HoleDistance& reading = set.distances[k];
    notes.push_back(fmt::format(
        "{} ({:g} mm on the tape) was left out: it is {:.1f} mm {} than the others "
        "predict, {:.1f} times the usual error of tape and holes. Measure it again.",
        words_of(set, reading), reading.distance_mm, std::abs(distance.left_out_mm),
        distance.left_out_mm > 0.0 ? "longer" : "shorter", std::abs(distance.sigmas())));
    ++at_hole[reading.from];
    if (!reading.edge) ++at_hole[reading.to];
  }
  for (const auto& [hole, count] : at_hole) {
    if (count < 2) continue;
    notes.push_back(
        fmt::format("{} of the distances that were left out end at hole {}: perhaps the hole is "
                    "misplaced and the tape is right.",
                    count, set.holes[hole].name));
  }
}

std::string tape_zero_sentence(const FoundTapeZero& zero) {
  return fmt::format(
      "Every tape distance reads {:.1f} +- {:.1f} mm too {}. This is corrected: {}",
      std::abs(zero.mm), zero.sigma_mm, zero.mm > 0.0 ? "long" : "short",
      zero.mm > 0.0
          ? "does it include the hook or the bit's width? Measure from centre to centre, or enter "
            "the offset (--hook-offset-mm)."
          : "was it measured between the near edges of the holes, or is the hook's offset "
            "too large?");
}

}  // namespace

FittedDistances fitted_distances(const observation::TapeDistances& distances,
                                 const estimation::Estimate& estimate, std::size_t observation) {
  const MeasuredHoles& set = distances.set();
  const estimation::ObservationEstimate& own = estimate.observations[observation];
  FittedDistances fit;
  fit.file = observation;
  for (const estimation::UnitEstimate& unit : estimate.units) {
    if (unit.observation != observation) continue;
    const auto at = as_index(unit.unit);
    fit.distances.push_back({distances.measured()[at], commanded_mm(set, set.distances[unit.unit]),
                             own.predicted[at], unit.left_out[0],
                             std::sqrt(unit.left_out_covariance(0, 0)), unit.is_rejected()});
  }
  const auto holes = std::ssize(set.holes);
  const VectorXd shift = own.nuisance.tail(2 * holes);
  for (Index i = 0; i < holes; ++i) {
    const estimation::PlaceEstimate& place = own.places[as_size(i)];
    fit.holes.push_back({distances.places()[as_size(i)].lengths,
                         place.as_stated,
                         place.mark,
                         {place.mark.x_mm + shift[2 * i], place.mark.y_mm + shift[2 * i + 1]}});
  }
  // After the sheet's size (tape_distances.hpp).
  constexpr Index kTapeZero = 2;
  if (tape_zero_sigma_mm(set.tape) > 0.0)
    fit.tape_zero = FoundTapeZero{own.nuisance[kTapeZero], own.nuisance_sigma[kTapeZero]};
  return fit;
}

MapPoint map_point(const FittedHole& hole) {
  MapPoint point;
  point.mark = hole.place;
  point.lengths = hole.lengths;
  const auto shifted = [&hole](MarkPoint from) { return difference(hole.place, from); };
  point.as_stated_mm = point.sheet_placed_mm = shifted(hole.as_stated);
  point.mapped_mm = point.left_out_mm = shifted(hole.predicted);
  return point;
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

std::vector<std::string> distance_notes(const MeasuredHoles& set, const FittedDistances& fit) {
  std::vector<std::string> notes;
  note_rejected(set, fit, notes);
  if (const auto tape_zero = suspected_tape_zero_offset_mm(set)) {
    notes.push_back(
        fmt::format("All distances are about {:.1f} mm {} than commanded, whatever their length: "
                    "was the tape's hook offset left out or subtracted twice?",
                    std::abs(*tape_zero), *tape_zero > 0.0 ? "longer" : "shorter"));
  } else if (fit.tape_zero &&
             std::abs(fit.tape_zero->mm) >= kTapeZeroSigmas * fit.tape_zero->sigma_mm) {
    notes.push_back(tape_zero_sentence(*fit.tape_zero));
  }
  return notes;
}

interp::Rectangle holes_domain(const Bed& bed) {
  constexpr double kMarginMm = 50.0;
  return area_of(bed, kMarginMm);
}

}  // namespace chaintrue::grid
