// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/holes/hole_distances.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>

#include "model/calibration/setting.hpp"
#include "model/controllers/payout.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;

struct EdgeRow {
  double size_mm;  ///< of the sheet, square to the edge
  int axis;        ///< 0: x, 1: y
  double sign;     ///< of the hole's coordinate in its distance from the edge
};

EdgeRow edge_row(const MeasuredHoles& set, SheetEdge edge) {
  const model::Bed bed = set.machine ? set.machine->bed : model::Bed{};
  const double width_mm = set.sheet.width_mm.value_or(bed.width_mm);
  const double height_mm = set.sheet.height_mm.value_or(bed.height_mm);
  switch (edge) {
    case SheetEdge::left:
      return {width_mm, 0, 1.0};
    case SheetEdge::right:
      return {width_mm, 0, -1.0};
    case SheetEdge::top:
      return {height_mm, 1, -1.0};
    case SheetEdge::bottom:
      break;
  }
  return {height_mm, 1, 1.0};
}

Eigen::MatrixXd hook_covariance(const MeasuredHoles& set) {
  const auto count = static_cast<Eigen::Index>(set.distances.size());
  Eigen::VectorXd session(count);
  for (Eigen::Index k = 0; k < count; ++k)
    session[k] = static_cast<double>(set.distances[static_cast<std::size_t>(k)].session);
  const Eigen::MatrixXd all = session.replicate(1, count);
  return std::pow(set.tape.hook_sigma_mm.value_or(0.0), 2) *
         (all.array() == all.transpose().array()).cast<double>().matrix();
}

bool is_of_sheet(model::Setting setting) { return setting >= model::Setting::sheet_x_mm; }

}  // namespace

DistanceGeometry distance_geometry(const MeasuredHoles& set, const std::vector<BedPoint>& marks) {
  const auto count = static_cast<Eigen::Index>(set.distances.size());
  DistanceGeometry geometry{
      Eigen::VectorXd::Zero(count),
      Eigen::MatrixXd::Zero(count, 2 * static_cast<Eigen::Index>(marks.size())),
      Eigen::MatrixXd::Zero(count, 2)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const HoleDistance& distance = set.distances[static_cast<std::size_t>(k)];
    const BedPoint from = marks.at(distance.from);
    const auto a = 2 * static_cast<Eigen::Index>(distance.from);
    if (distance.edge) {
      const EdgeRow row = edge_row(set, *distance.edge);
      geometry.predicted_mm[k] =
          0.5 * row.size_mm + row.sign * (row.axis == 0 ? from.x_mm : from.y_mm);
      geometry.by_mark(k, a + row.axis) = row.sign;
      // Half of what the sheet is too large stands before each of its edges.
      geometry.by_size(k, row.axis) = 0.5;
      continue;
    }
    const BedPoint to = marks.at(distance.to);
    const auto b = 2 * static_cast<Eigen::Index>(distance.to);
    const Eigen::Vector2d way(from.x_mm - to.x_mm, from.y_mm - to.y_mm);
    geometry.predicted_mm[k] = way.norm();
    const Eigen::Vector2d unit = way / way.norm();
    geometry.by_mark.block<1, 2>(k, a) = unit.transpose();
    geometry.by_mark.block<1, 2>(k, b) = -unit.transpose();
  }
  return geometry;
}

DistanceNoise distance_noise(const MeasuredHoles& set, const DistanceGeometry& geometry) {
  const Eigen::Index count = geometry.predicted_mm.size();
  DistanceNoise noise;
  noise.tape_mm2.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    noise.tape_mm2[k] = std::pow(sigma_of(set, set.distances[static_cast<std::size_t>(k)]), 2);
  }
  noise.holes_mm2 =
      set.hole_sigma_mm * set.hole_sigma_mm * geometry.by_mark * geometry.by_mark.transpose();
  noise.size_mm2 =
      std::pow(set.sheet.size_sigma_mm, 2) * geometry.by_size * geometry.by_size.transpose();
  noise.hook_mm2 = hook_covariance(set);
  return noise;
}

bool is_of_tape(const model::effects::Effect& effect, model::effects::EffectSide side) {
  return effect.station == model::effects::Station::paper &&
         side == model::effects::EffectSide::both;
}

double tape_factor(const model::Machine& machine) {
  double factor = 1.0;
  for (const model::effects::ActingEffect& acting : model::effects::acting_effects(machine)) {
    if (!is_of_tape(*acting.effect, acting.side)) continue;
    factor *= acting.effect->write({1.0, 0.0}, acting.side, acting.values).x_mm;
  }
  return factor;
}

tl::expected<HoleDistances, std::string> HoleDistances::of(MeasuredHoles set) {
  if (!set.machine) throw std::invalid_argument("holes without a machine predict no distances");
  HoleDistances result(std::move(set));
  const auto controller = model::make_controller_kinematics(*result.set_.machine);
  for (const Hole& hole : result.set_.holes) {
    const auto lengths = controller->lengths(hole.commanded);
    if (!lengths) {
      return tl::unexpected(
          fmt::format("hole {} at ({:.1f}, {:.1f}) is out of the controller's "
                      "reach: {}",
                      hole.name,
                      hole.commanded.x_mm,
                      hole.commanded.y_mm,
                      model::explain(lengths.error())));
    }
    result.lengths_.push_back(*lengths);
  }
  const auto count = static_cast<Eigen::Index>(result.set_.distances.size());
  result.measured_mm_.resize(count);
  for (Eigen::Index k = 0; k < count; ++k) {
    result.measured_mm_[k] =
        length_of(result.set_, result.set_.distances[static_cast<std::size_t>(k)]);
  }
  return result;
}

tl::expected<std::vector<HolePlace>, HoleFailure> HoleDistances::places(
    const model::ReadingModel& model, const model::SheetPlacement& sheet) const {
  std::vector<HolePlace> places;
  for (std::size_t i = 0; i < set_.holes.size(); ++i) {
    const auto reading = model.find(lengths_[i], set_.holes[i].commanded);
    if (!reading) return tl::unexpected(HoleFailure{i, reading.error()});
    places.push_back({*reading,
                      sheet.to_mark(reading->pose.position),
                      reading->position_jacobian * sheet.rotation()});
  }
  return places;
}

Eigen::Vector2d HoleDistances::mark_by_setting(const model::ReadingModel& model,
                                               const model::SheetPlacement& sheet,
                                               const HolePlace& place,
                                               model::Setting setting) {
  // f(sheet(m), settings) = l holds: dm = -(df/dm)^-1 df/ds ds
  const Eigen::Matrix2d to_mark = place.by_mark.inverse();
  if (!is_of_sheet(setting)) return -to_mark * model.sensitivity(place.reading, setting);
  const Eigen::Matrix<double, 2, 3> by_sheet =
      place.reading.position_jacobian * sheet.sensitivity(place.mark);
  return -to_mark * by_sheet.col(static_cast<Eigen::Index>(setting) -
                                 static_cast<Eigen::Index>(model::Setting::sheet_x_mm));
}

tl::expected<model::Linearisation, model::PoseFailure> HoleDistances::linearise(
    const model::ReadingModel& model,
    const model::SheetPlacement& sheet,
    const std::vector<model::Setting>& settings) const {
  const auto found = places(model, sheet);
  if (!found) return tl::unexpected(found.error().reason);
  Eigen::MatrixXd marks_by_setting(2 * static_cast<Eigen::Index>(found->size()),
                                   static_cast<Eigen::Index>(settings.size()));
  std::vector<BedPoint> marks;
  for (const HolePlace& place : *found) {
    const Eigen::Index row = 2 * static_cast<Eigen::Index>(marks.size());
    for (std::size_t s = 0; s < settings.size(); ++s) {
      marks_by_setting.block<2, 1>(row, static_cast<Eigen::Index>(s)) =
          mark_by_setting(model, sheet, place, settings[s]);
    }
    marks.push_back(place.mark);
  }
  const DistanceGeometry geometry = distance_geometry(set_, marks);
  const DistanceNoise noise = distance_noise(set_, geometry);
  model::Linearisation line;
  line.residual = measured_mm_ - geometry.predicted_mm;
  line.setting_jacobian = geometry.by_mark * marks_by_setting;
  line.covariance = noise.holes_mm2 + noise.size_mm2 + noise.hook_mm2;
  line.covariance.diagonal() += noise.tape_mm2;
  return line;
}

}  // namespace chaintrue::grid
