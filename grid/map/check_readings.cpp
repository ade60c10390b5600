// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_readings.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>
#include <utility>

#include "grid/containers.hpp"
#include "grid/failed.hpp"
#include "grid/map/check_parts.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/tape_zero.hpp"
#include "model/chains/chain_changes.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {
namespace {

using model::ChainLengths;

using Entries = std::vector<Eigen::Triplet<double>>;

/// The readings of all parts, row by row. What is sparse is gathered as entries.
class Gathered {
 public:
  explicit Gathered(const MapAt& at) : at_(at) {}

  /// `first` is where the part's places begin among all.
  void add(const CheckedPart& part, std::size_t first) {
    if (part.distances) {
      add_distances(part, first);
    } else {
      add_points(part, first);
    }
  }

  [[nodiscard]] CheckReadings readings() const {
    CheckReadings readings;
    const auto rows = std::ssize(residual_mm_);
    const auto places = std::ssize(at_.lengths);
    readings.residual_mm = Eigen::Map<const Eigen::VectorXd>(residual_mm_.data(), rows);
    readings.by_length.resize(rows, 2 * places);
    readings.by_length.setFromTriplets(by_length_.begin(), by_length_.end());
    ReadingCovariance& covariance = readings.covariance;
    covariance.own = own_;
    covariance.shared.resize(rows, shared_columns_);
    covariance.shared.setFromTriplets(shared_.begin(), shared_.end());
    covariance.of_map = narrowed(readings.by_length * at_.factor);
    readings.by_parameter = readings.by_length * at_.by_parameter;
    readings.lengths_mm.resize(2 * places);
    for (Eigen::Index i = 0; i < places; ++i) {
      const ChainLengths& lengths = at_.lengths[as_size(i)];
      readings.lengths_mm.segment<2>(2 * i) << lengths.left_mm, lengths.right_mm;
    }
    return readings;
  }

 private:
  [[nodiscard]] Eigen::Index row() const { return std::ssize(residual_mm_); }

  void add_points(const CheckedPart& part, std::size_t first) {
    const Eigen::Vector3d laid(
        part.placement.x_mm, part.placement.y_mm, part.placement.rotation_rad);
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      const ChainLengths& read = part.points[i].point.lengths;
      const ChainLengths& mapped = at_.lengths[first + i];
      const Eigen::Matrix2d& by_mark = at_.by_mark[first + i];
      Eigen::MatrixXd own =
          observation::covariance_of({part.noise.length_mm, part.noise.position_mm}, by_mark) /
          part.points[i].count;
      own.diagonal().array() += kLeastVarianceMm2;
      if (!at_.covariance.empty()) own += at_.covariance[first + i];
      own_.push_back(std::move(own));
      const auto chain = 2 * as_index(first + i);
      for (Eigen::Index side = 0; side < 2; ++side)
        by_length_.emplace_back(row() + side, chain + side, 1.0);
      Eigen::Vector2d residual(read.left_mm - mapped.left_mm, read.right_mm - mapped.right_mm);
      if (part.sheet) {
        const Eigen::Matrix<double, 2, 3> by_sheet =
            by_mark * part.placement.sensitivity(part.points[i].point.mark);
        residual += by_sheet * laid;
        add_sheet(*part.sheet, by_sheet, row());
      }
      residual_mm_.push_back(residual[0]);
      residual_mm_.push_back(residual[1]);
    }
    if (part.sheet) shared_columns_ += 3;
  }

  /// Displacement of a sheet from its intended place: an error that its readings share.
  void add_sheet(const observation::SheetPrior& sheet,
                 const Eigen::Matrix<double, Eigen::Dynamic, 3>& by_sheet,
                 Eigen::Index first_row) {
    const Eigen::Vector3d sigma(
        sheet.shift_sigma_mm, sheet.shift_sigma_mm, sheet.rotation_sigma_rad);
    for (Eigen::Index i = 0; i < by_sheet.rows(); ++i) {
      for (Eigen::Index k = 0; k < 3; ++k) {
        if (by_sheet(i, k) != 0.0)
          shared_.emplace_back(first_row + i, shared_columns_ + k, by_sheet(i, k) * sigma[k]);
      }
    }
  }

  void add_distances(const CheckedPart& part, std::size_t first) {
    const MeasuredHoles& set = part.distances->set();
    const observation::DistanceGeometry geometry = observation::distance_geometry(set, part.marks);
    const Eigen::VectorXd residual = part.distances->measured() - geometry.predicted_mm;
    const Eigen::Index before = row();
    for (Eigen::Index k = 0; k < residual.size(); ++k) {
      const HoleDistance& distance = set.distances[as_size(k)];
      residual_mm_.push_back(residual[k]);
      own_.push_back(Eigen::MatrixXd::Constant(1, 1, std::pow(sigma_of(set, distance), 2)));
      add_hole(geometry, set, before + k, k, first, distance.from);
      if (!distance.edge) add_hole(geometry, set, before + k, k, first, distance.to);
    }
    shared_columns_ += (at_.covariance.empty() ? 2 : 4) * std::ssize(set.holes);
    add_size_and_tape_zero(set, geometry, before);
    if (!part.sheet) return;
    // If a sheet moves, a hole's mark on it moves the other way; distances to edges depend on it,
    // with the rotation to first order.
    Eigen::Matrix<double, Eigen::Dynamic, 3> by_sheet =
        Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(residual.size(), 3);
    for (Eigen::Index k = 0; k < residual.size(); ++k) {
      const HoleDistance& distance = set.distances[as_size(k)];
      if (!distance.edge) continue;
      by_sheet.row(k) = -geometry.by_mark.block<1, 2>(k, 2 * as_index(distance.from)) *
                        model::SheetPlacement{}.sensitivity(part.marks[distance.from]);
    }
    add_sheet(*part.sheet, by_sheet, before);
    shared_columns_ += 3;
  }

  /// The effect of the chains at a hole, and of the hole's error, on one end of a distance.
  void add_hole(const observation::DistanceGeometry& geometry,
                const MeasuredHoles& set,
                Eigen::Index at_row,
                Eigen::Index distance,
                std::size_t first,
                std::size_t hole) {
    const auto column = 2 * as_index(hole);
    const Eigen::RowVector2d by_mark = geometry.by_mark.block<1, 2>(distance, column);
    // A chain reads more than the map predicts for the place: the tool is nearer to that motor.
    const Eigen::RowVector2d by_length = -by_mark * at_.by_mark[first + hole].inverse();
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      by_length_.emplace_back(at_row, 2 * as_index(first) + column + axis, by_length[axis]);
      shared_.emplace_back(
          at_row, shared_columns_ + column + axis, set.hole_sigma_mm * by_mark[axis]);
    }
    if (at_.covariance.empty()) return;
    // The map's uncertainty at the hole, which all of its distances share.
    const Eigen::Matrix2d root = Eigen::LLT<Eigen::Matrix2d>(at_.covariance[first + hole]).matrixL();
    const Eigen::RowVector2d found = by_length * root;
    const auto holes = 2 * std::ssize(set.holes);
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      shared_.emplace_back(at_row, shared_columns_ + holes + column + axis, found[axis]);
  }

  void add_size_and_tape_zero(const MeasuredHoles& set,
                         const observation::DistanceGeometry& geometry,
                         Eigen::Index before) {
    const double tape_zero_offset_sigma_mm = tape_zero_sigma_mm(set.tape);
    for (Eigen::Index k = 0; k < geometry.by_size.rows(); ++k) {
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        const double by_size = set.sheet.size_sigma_mm * geometry.by_size(k, axis);
        if (by_size != 0.0) shared_.emplace_back(before + k, shared_columns_ + axis, by_size);
      }
      if (tape_zero_offset_sigma_mm != 0.0)
        shared_.emplace_back(before + k, shared_columns_ + 2, tape_zero_offset_sigma_mm);
    }
    shared_columns_ += tape_zero_offset_sigma_mm != 0.0 ? 3 : 2;
  }

  const MapAt& at_;
  std::vector<double> residual_mm_;
  std::vector<Eigen::MatrixXd> own_;
  Entries by_length_;
  Entries shared_;
  Eigen::Index shared_columns_ = 0;
};

/// `of` distinguishes several files: "", or " of holes.json".
void name_rows(const CheckedPart& part, const std::string& of, CheckReadings& readings) {
  const auto add = [&readings](std::string name, std::size_t rows) {
    readings.units.push_back(
        {std::move(name), readings.units.size(), readings.names.size() - rows, rows});
  };
  for (const auto& [point, count] : part.points) {
    for (const char* side : {"left", "right"})
      readings.names.push_back(fmt::format("point {}{}, {} chain", point.index + 1, of, side));
    add(fmt::format("point {}{}", point.index + 1, of), 2);
  }
  if (!part.distances) return;
  for (const HoleDistance& distance : part.distances->set().distances) {
    readings.names.push_back(words_of(part.distances->set(), distance) + of);
    add(readings.names.back(), 1);
  }
}

}  // namespace

tl::expected<CheckReadings, CheckFailure> check_readings(const CompensationMap& map,
                                                         const Measured& measured,
                                                         const Progress& progress) {
  const std::vector<MeasuredFile>& files = measured.files();
  std::vector<CheckedPart> parts;
  std::vector<model::MarkPoint> marks;
  for (const MeasuredFile& file : files) {
    auto part =
        std::visit([&map](const auto& one) { return checked_part(map, one); }, file.measured);
    if (!part) {
      return failed(
          part.error().reason,
          (files.size() > 1 ? file.name + ": " : std::string{}) + part.error().sentence());
    }
    append_all(marks, part->marks);
    parts.push_back(*std::move(part));
  }
  const auto at = map_at(map, marks, progress);
  if (!at) return tl::unexpected(at.error());
  Gathered gathered(*at);
  std::size_t first = 0;
  for (const CheckedPart& part : parts) {
    gathered.add(part, first);
    first += part.marks.size();
  }
  CheckReadings readings = gathered.readings();
  constexpr double kUsualPitchMm = 6.35;
  readings.changes = map.machine() != nullptr
                         ? model::ReadingModel(*map.machine()).possible_changes()
                         : model::changes_of_chains(kUsualPitchMm);
  const model::ChainLengths zero =
      map.machine() != nullptr ? map.machine()->chain_zero : model::ChainLengths{};
  readings.zero_mm = {zero.left_mm, zero.right_mm};
  for (std::size_t k = 0; k < parts.size(); ++k)
    name_rows(parts[k], files.size() > 1 ? " of " + files[k].name : std::string{}, readings);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const std::string& note : parts[k].notes)
      readings.notes.push_back((files.size() > 1 ? files[k].name + ": " : std::string{}) + note);
  }
  return readings;
}

}  // namespace chaintrue::grid
