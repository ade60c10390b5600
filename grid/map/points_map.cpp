// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/points_map.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "grid/map/map_accuracy.hpp"
#include "grid/map/map_parts.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

Eigen::Vector2d to_tool(const Eigen::Matrix2d& mark_jacobian, const Eigen::Vector2d& chain_mm) {
  return mark_jacobian.inverse() * chain_mm;
}

/// How far the tool was beyond where its command sent it, on the sheet. The controller believes
/// neither the stated machine nor the catenary: a machine that goes where it is told is right.
Eigen::Vector2d beyond_mark(model::BedPoint commanded,
                            const model::SheetPlacement& sheet,
                            model::MarkPoint mark) {
  const model::BedPoint place = sheet.to_bed(mark);
  return sheet.rotation().transpose() *
         Eigen::Vector2d(commanded.x_mm - place.x_mm, commanded.y_mm - place.y_mm);
}

/// Fits the placement of the sheet under the machine as delivered, by weighted least squares on its
/// good points.
model::SheetPlacement fit_sheet_placement(const PointsFitInput& input,
                                          const PointsFit& fit,
                                          const model::ReadingModel& stated) {
  const std::vector<model::Setting> settings(model::kSheetSettings.begin(),
                                             model::kSheetSettings.end());
  std::vector<LengthPoint> good;
  for (const FittedPoint& point : fit.points) {
    if (!point.bad) good.push_back(point.point);
  }
  const observation::ChainLengthReadings readings =
      chain_length_readings(good, input.noise, 0.0, input.sheet);
  model::SheetPlacement sheet;
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    const auto line = readings.linearise({stated, sheet}, settings);
    if (!line) break;
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Vector3d right = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < good.size(); ++i) {
      const auto row = 2 * static_cast<Eigen::Index>(i);
      const Eigen::Matrix2d weight = line->units[i].covariance.inverse();
      const Eigen::MatrixXd by_sheet = line->by_setting.middleRows(row, 2);
      const auto& commanded = good[i].commanded;
      const Eigen::Vector2d residual =
          commanded ? line->places[i].by_mark * beyond_mark(*commanded, sheet, good[i].mark)
                    : Eigen::Vector2d(readings.measured().segment(row, 2) -
                                      line->predicted.segment(row, 2));
      normal += by_sheet.transpose() * weight * by_sheet;
      right += by_sheet.transpose() * weight * residual;
    }
    const Eigen::Vector3d change = normal.ldlt().solve(right);
    sheet.x_mm += change[0];
    sheet.y_mm += change[1];
    sheet.rotation_rad += change[2];
  }
  return sheet;
}

/// How far the tool was beyond where the machine as delivered thinks: the command, or where the
/// lengths put it; zero where that machine has no pose.
Eigen::Vector2d tool_residual(const model::ReadingModel& model,
                              const model::SheetPlacement& sheet,
                              const LengthPoint& point) {
  if (point.commanded) return beyond_mark(*point.commanded, sheet, point.mark);
  const auto reading = model.at(sheet.to_bed(point.mark));
  if (!reading) return Eigen::Vector2d::Zero();
  return to_tool(reading->position_jacobian * sheet.rotation(),
                 Eigen::Vector2d(point.lengths.left_mm - reading->lengths.left_mm,
                                 point.lengths.right_mm - reading->lengths.right_mm));
}

std::vector<std::string> notes_of(const MapContents& map) {
  std::vector<std::string> notes;
  if (map.noise.source == "stated" && map.noise.factor_found > kNoiseDisagreement) {
    notes.push_back(
        fmt::format("The readings scatter {:.1f} times as much as stated: check how the marks and "
                    "the lengths were measured.",
                    map.noise.factor_found));
  }
  if (map.noise.source != "stated") {
    notes.push_back(
        fmt::format("No noise was stated; from the {} it is about {:.2f} mm in a length and {:.2f} "
                    "mm in a position.",
                    map.noise.source == "repeats" ? "repeated points" : "scatter of the points",
                    map.noise.length_mm * map.noise.factor_found,
                    map.noise.position_mm * map.noise.factor_found));
  }
  for (std::size_t i = 0; i < map.points.size(); ++i) {
    const MapPoint& point = map.points[i];
    if (!point.bad) continue;
    notes.push_back(
        fmt::format("Point {} at ({:.0f}, {:.0f}) was set aside: it lies {:.1f} mm beside where "
                    "the others put it, {:.0f} times what "
                    "the noise allows. Measure it again.",
                    i + 1,
                    point.mark.x_mm,
                    point.mark.y_mm,
                    point.left_out_mm.norm(),
                    point.distance_sigmas));
  }
  note_settings_off(map.settings, notes);
  return notes;
}

void append_lattice_notes(std::vector<std::string>& notes, const LatticeResidual& lattice) {
  notes.emplace_back(
      "The readings bear no noise and stand on full rows and columns: the map passes through every "
      "one of them.");
  for (Eigen::Index iy = 0; iy < lattice.doubt_mm.cols(); ++iy) {
    for (Eigen::Index ix = 0; ix < lattice.doubt_mm.rows(); ++ix) {
      if (lattice.doubt_mm(ix, iy) == 0.0) continue;
      notes.push_back(
          fmt::format("No reading at ({:.0f}, {:.0f}) was used: what stands there is foretold by "
                      "the row or column through it, to "
                      "about {:.2g} mm.",
                      lattice.x_nodes_mm[static_cast<std::size_t>(ix)],
                      lattice.y_nodes_mm[static_cast<std::size_t>(iy)],
                      lattice.doubt_mm(ix, iy)));
    }
  }
}

}  // namespace

std::vector<MapPoint> map_points(const PointsFitInput& input,
                                 const PointsFit& fit,
                                 const MeasuredGrid& grid) {
  const model::ReadingModel stated(*grid.machine);
  const model::SheetPlacement laid =
      grid.sheet ? fit_sheet_placement(input, fit, stated) : model::SheetPlacement{};
  std::vector<MapPoint> points;
  for (const FittedPoint& fitted : fit.points) {
    MapPoint point;
    point.mark = fitted.point.mark;
    point.lengths = fitted.point.lengths;
    point.bad = fitted.bad;
    point.distance_sigmas = fitted.distance;
    point.as_stated_mm = tool_residual(stated, {}, fitted.point);
    point.sheet_placed_mm = tool_residual(stated, laid, fitted.point);
    point.mapped_mm = to_tool(fitted.mark_jacobian, fitted.residual_mm);
    point.left_out_mm = to_tool(fitted.mark_jacobian, fitted.left_out_residual_mm);
    points.push_back(point);
  }
  return points;
}

MapAccuracy held_out_accuracy(const std::vector<FittedPoint>& points) {
  std::vector<HeldOutResidual> one;
  std::vector<HeldOutResidual> blocks;
  for (const FittedPoint& point : points) {
    if (point.bad) continue;
    one.push_back({point.left_out_residual_mm, point.mark_jacobian});
    blocks.push_back({point.blocked_residual_mm, point.mark_jacobian});
  }
  MapAccuracy accuracy;
  accuracy.leave_one_out = summarise(one);
  accuracy.blocked = summarise(blocks);
  return accuracy;
}

CompensationMap map_of(const MeasuredGrid& grid, const FittedGrid& fitted) {
  const PointsFitInput& input = fitted.input;
  const PointsFit& fit = fitted.fit;
  MapContents map;
  map.name = grid.name;
  map.surface = model_surface(fit.estimate);
  std::vector<model::MarkPoint> good;
  for (const FittedPoint& point : fit.points) {
    if (!point.bad) good.push_back(point.point.mark);
  }
  const MeasuredArea area(good, input.domain);
  map.hull = area.hull();
  map.edge_mm = area.edge_mm();
  map.domain = input.domain;
  map.noise = {input.noise.length_mm,
               input.noise.position_mm,
               fitted.noise_source,
               fit.estimate.noise_factor};
  map.accuracy = held_out_accuracy(fit.points);
  map.settings = setting_results(input.machine, fit.estimate, input.sheet);
  map.points = map_points(input, fit, grid);
  map.notes = notes_of(map);
  if (!fit.estimate.settled) {
    map.notes.push_back(
        "The fit had not quite settled after its last pass: some points hover between good and "
        "bad. "
        "Measure the ones with the largest residuals again.");
  }
  if (fitted.lattice) {
    std::get<ModelSurface>(map.surface).lattice = fitted.lattice;
    append_lattice_notes(map.notes, *fitted.lattice);
  }
  const CompensationMap finished = with_expected_error(std::move(map));
  return finished.with_mirror(test_mirror(finished));
}

}  // namespace chaintrue::grid
