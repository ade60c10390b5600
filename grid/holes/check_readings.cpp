// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/holes/check_readings.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "grid/map/length_points.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/tape_distances.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::BedPoint;
using model::ChainLengths;

using Reason = CheckFailure::Reason;

tl::unexpected<CheckFailure> fail(Reason reason, std::string sentence) {
  return tl::unexpected(CheckFailure{reason, std::move(sentence)});
}

constexpr std::array kMotors = {model::Setting::motor_left_x_mm,
                                model::Setting::motor_left_y_mm,
                                model::Setting::motor_right_x_mm,
                                model::Setting::motor_right_y_mm};

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
                                         Eigen::Matrix2Xd& by_motor) {
  const observation::View view{model, surface.sheet};
  const auto reading = model.at(surface.sheet.to_bed(mark));
  if (!reading) return std::nullopt;
  by_motor =
      observation::lengths_by_setting(view, *reading, mark, {kMotors.begin(), kMotors.end()});
  return design_rows(surface.residual.basis,
                     surface.columns,
                     mark,
                     reading->lengths,
                     observation::lengths_by_setting(view, *reading, mark, surface.settings));
}

tl::expected<MapAt, CheckFailure> map_at(const CompensationMap& map,
                                         const std::vector<BedPoint>& marks) {
  const auto count = static_cast<Eigen::Index>(marks.size());
  MapAt at;
  at.covariance = Eigen::MatrixXd::Zero(2 * count, 2 * count);
  const auto* surface = std::get_if<ModelSurface>(&map.contents().surface);
  // A lattice's doubt is no linear function of the unknowns: its points stand for themselves.
  const bool is_joint = surface != nullptr && !surface->lattice;
  at.by_motor.resize(2 * count, surface != nullptr ? kMotors.size() : 0);
  Eigen::MatrixXd factor;
  if (is_joint) factor.resize(2 * count, surface->columns.total());
  std::optional<model::ReadingModel> model;
  if (surface != nullptr) model.emplace(surface->machine);
  for (Eigen::Index i = 0; i < count; ++i) {
    const BedPoint mark = marks[static_cast<std::size_t>(i)];
    const auto answer = map.query(mark);
    if (!answer) {
      return fail(
          Reason::unreachable,
          fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm, mark.y_mm, explain(answer.error())));
    }
    at.lengths.push_back(answer->lengths);
    at.by_mark.push_back(answer->mark_jacobian);
    at.covariance.block<2, 2>(2 * i, 2 * i) = answer->covariance;
    if (surface == nullptr) continue;
    Eigen::Matrix2Xd by_motor;
    const auto design = design_at(*surface, *model, mark, by_motor);
    if (!design) {
      return fail(
          Reason::unreachable,
          fmt::format(
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

tl::unexpected<CheckFailure> too_many(std::size_t found, std::size_t most, const char* what) {
  return fail(
      Reason::too_many_readings,
      fmt::format(
          "{} {} are more than a check takes ({}); three to five that lie far from each other tell "
          "as much, and a map of all of them is made by chaintrue fit",
          found,
          what,
          most));
}

/// The new points of one file: where they are on the map, and what they say there.
struct Part {
  std::vector<BedPoint> marks;
  std::vector<Repeated> points;  ///< of a grid
  StatedNoise noise;
  std::optional<observation::TapeDistances> distances;
};

tl::expected<Part, CheckFailure> part_of(const CompensationMap& map, const MeasuredGrid& grid) {
  MeasuredGrid with_machine = grid;
  if (!with_machine.machine && map.machine() != nullptr) with_machine.machine = *map.machine();
  const auto points = length_points(with_machine);
  if (!points) return fail(Reason::no_lengths, points.error().sentence);
  Part part;
  part.points = merged(*points);
  if (part.points.size() > kMostCheckedPoints)
    return too_many(part.points.size(), kMostCheckedPoints, "points");
  part.noise = grid.noise.value_or(StatedNoise{});
  for (const Repeated& one : part.points) part.marks.push_back(one.point.mark);
  return part;
}

tl::expected<Part, CheckFailure> part_of(const CompensationMap& map, const MeasuredHoles& set) {
  if (!set.machine) {
    return fail(
        Reason::no_machine,
        "the holes name no machine; what was commanded becomes chain lengths by its controller");
  }
  if (set.distances.size() > kMostCheckedDistances)
    return too_many(set.distances.size(), kMostCheckedDistances, "distances");
  auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) return fail(Reason::no_lengths, distances.error());
  Part part;
  for (const observation::Place& place : distances->places()) {
    const auto mark = map.inverse(place.lengths);
    if (!mark) {
      return fail(Reason::unreachable,
                  fmt::format("hole {}: {}", place.name, explain(mark.error())));
    }
    part.marks.push_back(*mark);
  }
  part.distances = *std::move(distances);
  return part;
}

/// Rows of a part: what is left of its readings, by the chains at its own places, and their noise.
struct Rows {
  Eigen::VectorXd residual_mm;
  Eigen::MatrixXd by_chain;
  Eigen::MatrixXd noise;
};

/// `first` is where the part's places begin among all.
Rows rows_of_points(const Part& part, const MapAt& at, std::size_t first) {
  const auto count = 2 * static_cast<Eigen::Index>(part.points.size());
  Rows rows{Eigen::VectorXd(count),
            Eigen::MatrixXd::Identity(count, count),
            Eigen::MatrixXd::Zero(count, count)};
  for (std::size_t i = 0; i < part.points.size(); ++i) {
    const auto row = 2 * static_cast<Eigen::Index>(i);
    const ChainLengths& read = part.points[i].point.lengths;
    const ChainLengths& told = at.lengths[first + i];
    const Eigen::Matrix2d& by_mark = at.by_mark[first + i];
    rows.residual_mm.segment<2>(row) << read.left_mm - told.left_mm, read.right_mm - told.right_mm;
    rows.noise.block<2, 2>(row, row) =
        observation::covariance_of({part.noise.length_mm, part.noise.position_mm}, by_mark) /
        part.points[i].count;
  }
  return rows;
}

Rows rows_of_distances(const Part& part, const MapAt& at, std::size_t first) {
  const MeasuredHoles& set = part.distances->set();
  const observation::DistanceGeometry geometry = observation::distance_geometry(set, part.marks);
  const observation::DistanceNoise noise = observation::distance_noise(set, geometry);
  const auto places = static_cast<Eigen::Index>(part.marks.size());
  Eigen::MatrixXd marks_by_chain = Eigen::MatrixXd::Zero(2 * places, 2 * places);
  for (Eigen::Index i = 0; i < places; ++i) {
    // More read on a chain than the map says for the same place: the tool is nearer to that motor.
    marks_by_chain.block<2, 2>(2 * i, 2 * i) =
        -at.by_mark[first + static_cast<std::size_t>(i)].inverse();
  }
  Rows rows{part.distances->measured() - geometry.predicted_mm,
            geometry.by_mark * marks_by_chain,
            noise.holes_mm2 + noise.size_mm2 + noise.hook_mm2};
  rows.noise.diagonal() += noise.tape_mm2;
  return rows;
}

/// `of` tells files apart where there are several: "", or " of holes.json".
void name_rows(const Part& part, const std::string& of, Eigen::Index row, CheckReadings& readings) {
  for (const auto& [point, count] : part.points) {
    readings.groups.push_back({row, row + 1});
    row += 2;
    readings.group_names.push_back(fmt::format("point {}{}", point.index + 1, of));
    for (const char* side : {"left", "right"})
      readings.names.push_back(fmt::format("point {}{}, {} chain", point.index + 1, of, side));
  }
  if (!part.distances) return;
  for (const HoleDistance& distance : part.distances->set().distances) {
    readings.groups.push_back({row++});
    readings.names.push_back(words_of(part.distances->set(), distance) + of);
    readings.group_names.push_back(readings.names.back());
  }
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

tl::expected<CheckReadings, CheckFailure> check_readings(const CompensationMap& map,
                                                         const Measured& measured) {
  const std::vector<MeasuredFile>& files = measured.files();
  std::vector<Part> parts;
  std::vector<BedPoint> marks;
  for (const MeasuredFile& file : files) {
    auto part = std::visit([&map](const auto& one) { return part_of(map, one); }, file.measured);
    if (!part) {
      return fail(part.error().reason,
                  (files.size() > 1 ? file.name + ": " : std::string{}) + part.error().sentence);
    }
    marks.insert(marks.end(), part->marks.begin(), part->marks.end());
    parts.push_back(*std::move(part));
  }
  const auto at = map_at(map, marks);
  if (!at) return tl::unexpected(at.error());
  CheckReadings readings;
  fill_common(readings, map, *at);
  const auto chains = 2 * static_cast<Eigen::Index>(marks.size());
  std::size_t first = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Part& part = parts[k];
    const Rows rows =
        part.distances ? rows_of_distances(part, *at, first) : rows_of_points(part, *at, first);
    const Eigen::Index before = readings.residual_mm.size();
    const Eigen::Index count = rows.residual_mm.size();
    readings.residual_mm.conservativeResize(before + count);
    readings.residual_mm.tail(count) = rows.residual_mm;
    readings.by_chain.conservativeResizeLike(Eigen::MatrixXd::Zero(before + count, chains));
    readings.by_chain.block(
        before, 2 * static_cast<Eigen::Index>(first), count, rows.by_chain.cols()) = rows.by_chain;
    readings.covariance.conservativeResizeLike(
        Eigen::MatrixXd::Zero(before + count, before + count));
    readings.covariance.bottomRightCorner(count, count) = rows.noise;
    name_rows(part, files.size() > 1 ? " of " + files[k].name : std::string{}, before, readings);
    first += part.marks.size();
  }
  readings.covariance += readings.by_chain * at->covariance * readings.by_chain.transpose();
  return readings;
}

}  // namespace chaintrue::grid
