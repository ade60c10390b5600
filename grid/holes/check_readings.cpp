// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/holes/check_readings.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <utility>

#include "grid/holes/hole_distances.hpp"
#include "grid/map/length_points.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::ChainLengths;

/// The map at N places: d(lengths)/d(mark), and what it does not know of its lengths there, all
/// places together.
struct MapAt {
  std::vector<ChainLengths> lengths;
  std::vector<Eigen::Matrix2d> by_mark;
  Eigen::MatrixXd covariance;  ///< 2 N squared
  Eigen::MatrixXd by_motor;    ///< 2 N x 4 or x 0
};

/// Columns of d(lengths)/d(settings) at a mark, in the order of the surface's settings.
std::optional<Eigen::MatrixXd> design_at(const ModelSurface& surface,
                                         const model::ReadingModel& model,
                                         BedPoint mark,
                                         Eigen::Matrix<double, 2, 4>& by_motor) {
  const auto reading = model.at(surface.sheet.to_bed(mark));
  if (!reading) return std::nullopt;
  const Eigen::Matrix<double, 2, 3> by_sheet =
      reading->position_jacobian * surface.sheet.sensitivity(mark);
  Eigen::MatrixXd by_setting(2, surface.columns.settings);
  for (Eigen::Index s = 0; s < surface.columns.settings; ++s) {
    const model::Setting setting = surface.settings[static_cast<std::size_t>(s)];
    by_setting.col(s) =
        setting >= model::Setting::sheet_x_mm
            ? Eigen::Vector2d(by_sheet.col(static_cast<Eigen::Index>(setting) -
                                           static_cast<Eigen::Index>(model::Setting::sheet_x_mm)))
            : model.sensitivity(*reading, setting);
  }
  for (Eigen::Index s = 0; s < 4; ++s) {
    by_motor.col(s) =
        model.sensitivity(*reading, model::kMachineSettings[static_cast<std::size_t>(s)]);
  }
  return design_rows(surface.residual.basis, surface.columns, mark, reading->lengths, by_setting);
}

tl::expected<MapAt, std::string> map_at(const CompensationMap& map,
                                        const std::vector<BedPoint>& marks) {
  const auto count = static_cast<Eigen::Index>(marks.size());
  MapAt at;
  at.covariance = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  const auto* surface = std::get_if<ModelSurface>(&map.contents().surface);
  // A lattice's doubt is no linear function of the unknowns: its points stand for themselves.
  const bool is_joint = surface != nullptr && !surface->lattice;
  at.by_motor.resize(2 * count, surface != nullptr ? 4 : 0);
  Eigen::MatrixXd factor;
  if (is_joint) factor.resize(2 * count, surface->columns.total());
  std::optional<model::ReadingModel> model;
  if (surface != nullptr) model.emplace(surface->machine);
  for (Eigen::Index i = 0; i < count; ++i) {
    const BedPoint mark = marks[static_cast<std::size_t>(i)];
    const auto answer = map.query(mark);
    if (!answer) {
      return tl::unexpected(
          fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm, mark.y_mm, explain(answer.error())));
    }
    at.lengths.push_back(answer->lengths);
    at.by_mark.push_back(answer->mark_jacobian);
    at.covariance.block<2, 2>(2 * i, 2 * i) = answer->covariance;
    if (surface == nullptr) continue;
    Eigen::Matrix<double, 2, 4> by_motor;
    const auto design = design_at(*surface, *model, mark, by_motor);
    if (!design) {
      return tl::unexpected(fmt::format(
          "({:.1f}, {:.1f}): the calibrated machine has no pose there", mark.x_mm, mark.y_mm));
    }
    at.by_motor.middleRows(2 * i, 2) = by_motor;
    if (is_joint) factor.middleRows(2 * i, 2) = *design * surface->covariance_factor;
  }
  if (is_joint) at.covariance = factor * factor.transpose();
  return at;
}

/// Readings at one mark are as good as their mean, and a check costs the cube of their number.
struct Repeated {
  LengthPoint point;  ///< the first of them, with the mean of all lengths
  double count = 0.0;
};

std::vector<Repeated> merged(const std::vector<LengthPoint>& points) {
  std::map<std::pair<double, double>, std::size_t> at;
  std::vector<Repeated> result;
  for (const LengthPoint& point : points) {
    const auto [place, is_new] =
        at.emplace(std::pair(point.mark.x_mm, point.mark.y_mm), result.size());
    if (is_new) result.push_back({point, 0.0});
    Repeated& one = result[place->second];
    one.count += 1.0;
    one.point.lengths.left_mm += (point.lengths.left_mm - one.point.lengths.left_mm) / one.count;
    one.point.lengths.right_mm += (point.lengths.right_mm - one.point.lengths.right_mm) / one.count;
  }
  return result;
}

std::string too_many(std::size_t found, std::size_t most, const char* what) {
  return fmt::format(
      "{} {} are more than a check takes ({}); three to five that lie far from each other tell "
      "as much, and a map of all of them is made by chaintrue fit",
      found,
      what,
      most);
}

void fill_common(CheckReadings& readings, const CompensationMap& map, const MapAt& at) {
  const auto places = static_cast<Eigen::Index>(at.lengths.size());
  readings.lengths_mm = Eigen::MatrixXd::Zero(2 * places, 2);
  for (Eigen::Index i = 0; i < places; ++i) {
    readings.lengths_mm(2 * i, 0) = at.lengths[static_cast<std::size_t>(i)].left_mm;
    readings.lengths_mm(2 * i + 1, 1) = at.lengths[static_cast<std::size_t>(i)].right_mm;
  }
  readings.by_motor = at.by_motor;
  if (const model::Machine* machine = map.machine()) {
    readings.pitch_mm = machine->sprocket.pitch_mm;
    readings.zero = machine->chain_zero;
  }
}

}  // namespace

tl::expected<CheckReadings, std::string> check_readings(const CompensationMap& map,
                                                        const MeasuredGrid& grid) {
  MeasuredGrid with_machine = grid;
  if (!with_machine.machine && map.machine() != nullptr) with_machine.machine = *map.machine();
  const auto points = length_points(with_machine);
  if (!points) return tl::unexpected(points.error().sentence);
  const std::vector<Repeated> repeated = merged(*points);
  if (repeated.size() > kMostCheckedPoints)
    return tl::unexpected(too_many(repeated.size(), kMostCheckedPoints, "points"));
  std::vector<BedPoint> marks;
  for (const Repeated& one : repeated) marks.push_back(one.point.mark);
  auto at = map_at(map, marks);
  if (!at) return tl::unexpected(at.error());
  const auto count = static_cast<Eigen::Index>(repeated.size());
  const StatedNoise noise = grid.noise.value_or(StatedNoise{});
  CheckReadings readings;
  fill_common(readings, map, *at);
  readings.residual_mm.resize(2 * count);
  readings.by_chain = Eigen::MatrixXd::Identity(2 * count, 2 * count);
  readings.covariance = at->covariance;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const LengthPoint& point = repeated[k].point;
    readings.residual_mm[2 * i] = point.lengths.left_mm - at->lengths[k].left_mm;
    readings.residual_mm[2 * i + 1] = point.lengths.right_mm - at->lengths[k].right_mm;
    readings.covariance.block<2, 2>(2 * i, 2 * i) +=
        (noise.length_mm * noise.length_mm * Eigen::Matrix2d::Identity() +
         noise.position_mm * noise.position_mm * at->by_mark[k] * at->by_mark[k].transpose()) /
        repeated[k].count;
    readings.groups.push_back({2 * i, 2 * i + 1});
    readings.group_names.push_back(fmt::format("point {}", point.index + 1));
    readings.names.push_back(fmt::format("point {}, left chain", point.index + 1));
    readings.names.push_back(fmt::format("point {}, right chain", point.index + 1));
  }
  return readings;
}

tl::expected<CheckReadings, std::string> check_readings(const CompensationMap& map,
                                                        const MeasuredHoles& set) {
  MeasuredHoles with_machine = set;
  if (!with_machine.machine) {
    return tl::unexpected(std::string(
        "the holes name no machine; what was commanded becomes chain lengths by its controller"));
  }
  if (set.distances.size() > kMostCheckedDistances)
    return tl::unexpected(too_many(set.distances.size(), kMostCheckedDistances, "distances"));
  const auto distances = HoleDistances::of(with_machine);
  if (!distances) return tl::unexpected(distances.error());
  std::vector<BedPoint> marks;
  for (std::size_t i = 0; i < set.holes.size(); ++i) {
    const auto mark = map.inverse(distances->lengths()[i]);
    if (!mark) {
      return tl::unexpected(fmt::format("hole {}: {}", set.holes[i].name, explain(mark.error())));
    }
    marks.push_back(*mark);
  }
  auto at = map_at(map, marks);
  if (!at) return tl::unexpected(at.error());
  const DistanceGeometry geometry = distance_geometry(with_machine, marks);
  const DistanceNoise noise = distance_noise(with_machine, geometry);
  CheckReadings readings;
  fill_common(readings, map, *at);
  readings.residual_mm = distances->measured_mm() - geometry.predicted_mm;
  const auto places = static_cast<Eigen::Index>(marks.size());
  Eigen::MatrixXd marks_by_chain = Eigen::MatrixXd::Zero(2 * places, 2 * places);
  for (Eigen::Index i = 0; i < places; ++i) {
    // More read on a chain than the map says for the same place: the tool is nearer to that motor.
    marks_by_chain.block<2, 2>(2 * i, 2 * i) = -at->by_mark[static_cast<std::size_t>(i)].inverse();
  }
  readings.by_chain = geometry.by_mark * marks_by_chain;
  readings.covariance = readings.by_chain * at->covariance * readings.by_chain.transpose() +
                        noise.holes_mm2 + noise.size_mm2 + noise.hook_mm2;
  readings.covariance.diagonal() += noise.tape_mm2;
  for (std::size_t k = 0; k < set.distances.size(); ++k) {
    readings.groups.push_back({static_cast<Eigen::Index>(k)});
    readings.names.push_back(words_of(set, set.distances[k]));
    readings.group_names.push_back(readings.names.back());
  }
  return readings;
}

}  // namespace chaintrue::grid
