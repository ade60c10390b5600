// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_readings.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>

#include "grid/estimation/placement_fit.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/tape_distances.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::ChainLengths;
using model::MarkPoint;

using Reason = CheckFailure::Reason;

tl::unexpected<CheckFailure> fail(Reason reason, std::string sentence) {
  return tl::unexpected(CheckFailure{reason, std::move(sentence)});
}

constexpr std::array kMotors = {model::Setting::motor_left_x_mm,
                                model::Setting::motor_left_y_mm,
                                model::Setting::motor_right_x_mm,
                                model::Setting::motor_right_y_mm};

/// A sheet that is said to lie exactly is held by these: an inverse of nothing has no value.
constexpr double kLeastShiftMm = 1e-6;
constexpr double kLeastTurnRad = 1e-9;

/// No reading of a workshop is nearer.
constexpr double kLeastVarianceMm2 = observation::kKnownNuisanceMm * observation::kKnownNuisanceMm;

using Entries = std::vector<Eigen::Triplet<double>>;

/// The map at N places: d(lengths)/d(mark), and what it does not know of its lengths there: F F',
/// all places together, or each for itself.
struct MapAt {
  std::vector<ChainLengths> lengths;
  std::vector<Eigen::Matrix2d> by_mark;
  Eigen::MatrixXd factor;                   ///< F, 2 N x any
  std::vector<Eigen::Matrix2d> covariance;  ///< of each place; empty where F has it
  Eigen::MatrixXd by_motor;                 ///< 2 N x 4 or x 0
};

/// Columns of d(lengths)/d(settings) at a mark, in the order of the surface's settings.
std::optional<Eigen::MatrixXd> design_at(const ModelSurface& surface,
                                         const model::ReadingModel& model,
                                         MarkPoint mark,
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
                                         const std::vector<MarkPoint>& marks,
                                         const Progress& progress) {
  const auto count = static_cast<Eigen::Index>(marks.size());
  MapAt at;
  const auto* surface = std::get_if<ModelSurface>(&map.contents().surface);
  // A lattice's doubt is no linear function of the unknowns: its points stand for themselves.
  const bool is_joint = surface != nullptr && !surface->lattice;
  at.by_motor.resize(2 * count, surface != nullptr ? static_cast<Eigen::Index>(kMotors.size()) : 0);
  Eigen::MatrixXd design(2 * count, is_joint ? surface->columns.total() : 0);
  std::optional<model::ReadingModel> model;
  if (surface != nullptr) model.emplace(surface->machine);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / static_cast<double>(count);
    tell(progress, {"the map at the new points", 1, 2, share});
    const MarkPoint mark = marks[static_cast<std::size_t>(i)];
    const auto refused = [&mark](const MapFailure& failure) {
      return fail(Reason::unreachable,
                  fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm, mark.y_mm, explain(failure)));
    };
    if (is_joint) {
      const auto here = map.lengths(mark);
      if (!here) return refused(here.error());
      at.lengths.push_back(here->lengths);
      at.by_mark.push_back(here->mark_jacobian);
    } else {
      const auto answer = map.query(mark);
      if (!answer) return refused(answer.error());
      at.lengths.push_back(answer->lengths);
      at.by_mark.push_back(answer->mark_jacobian);
      at.covariance.push_back(answer->covariance);
    }
    if (surface == nullptr) continue;
    Eigen::Matrix2Xd by_motor;
    const auto rows = design_at(*surface, *model, mark, by_motor);
    if (!rows) {
      return fail(
          Reason::unreachable,
          fmt::format(
              "({:.1f}, {:.1f}): the calibrated machine has no pose there", mark.x_mm, mark.y_mm));
    }
    at.by_motor.middleRows(2 * i, 2) = by_motor;
    if (is_joint) design.middleRows(2 * i, 2) = *rows;
  }
  at.factor = is_joint ? Eigen::MatrixXd(design * surface->covariance_factor)
                       : Eigen::MatrixXd(2 * count, 0);
  return at;
}

/// Readings at one mark are as good as their mean.
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

/// Readings of one distance: their mean, weighted by what each is worth.
MeasuredHoles merged(const MeasuredHoles& set) {
  std::map<std::tuple<std::size_t, std::size_t, std::optional<SheetEdge>>, std::size_t> at;
  MeasuredHoles result = set;
  result.distances.clear();
  std::vector<double> precision;
  for (const HoleDistance& distance : set.distances) {
    const std::size_t to = distance.edge ? distance.from : distance.to;
    const auto [place, is_new] = at.emplace(
        std::tuple(std::min(distance.from, to), std::max(distance.from, to), distance.edge),
        result.distances.size());
    if (is_new) {
      result.distances.push_back(distance);
      precision.push_back(0.0);
    }
    HoleDistance& one = result.distances[place->second];
    double& sum = precision[place->second];
    const double own = 1.0 / std::pow(sigma_of(set, distance), 2);
    sum += own;
    one.distance_mm += own / sum * (distance.distance_mm - one.distance_mm);
    if (sum > own) one.sigma_mm = 1.0 / std::sqrt(sum);
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
struct CheckedPart {
  std::vector<MarkPoint> marks;  ///< on the map
  /// Of a sheet that was laid anew: how well, and where the readings put it in the map's frame. All
  /// is linearised there.
  std::optional<observation::SheetPrior> sheet;
  model::SheetPlacement placement;
  std::vector<std::string> notes;
  std::vector<Repeated> points;  ///< of a grid
  StatedNoise noise;
  std::optional<observation::TapeDistances> distances;
};

/// Lays the sheet where the readings put it, as far as its prior lets them, and the marks with it.
void lay(const CompensationMap& map, CheckedPart& part) {
  const auto on_map = [](const model::SheetPlacement& sheet, MarkPoint mark) {
    const model::BedPoint place = sheet.to_bed(mark);
    return MarkPoint{place.x_mm, place.y_mm};
  };
  const observation::PointNoise noise{part.noise.length_mm, part.noise.position_mm};
  part.placement = estimation::fit_placement(
      [&](const model::SheetPlacement& sheet, estimation::PlacementNormal& sum) {
        for (const Repeated& one : part.points) {
          const MarkPoint& mark = one.point.mark;
          const auto here = map.lengths(on_map(sheet, mark));
          if (!here) return false;
          Eigen::Matrix2d covariance =
              observation::covariance_of(noise, here->mark_jacobian) / one.count;
          covariance.diagonal().array() += kLeastVarianceMm2;
          sum.add({one.point.lengths.left_mm - here->lengths.left_mm,
                   one.point.lengths.right_mm - here->lengths.right_mm},
                  here->mark_jacobian * sheet.sensitivity(mark),
                  covariance.inverse());
        }
        return true;
      },
      part.sheet);
  for (std::size_t i = 0; i < part.marks.size(); ++i)
    part.marks[i] = on_map(part.placement, part.points[i].point.mark);
}

tl::expected<CheckedPart, CheckFailure> part_of(const CompensationMap& map,
                                                const MeasuredGrid& grid) {
  MeasuredGrid with_machine = grid;
  if (!with_machine.machine && map.machine() != nullptr) with_machine.machine = *map.machine();
  // A map is free of what belongs to the paper and to the visit: so must be what is held against it.
  const auto corrected = corrected_data(with_machine);
  if (!corrected) {
    return fail(corrected.error().reason == FitFailure::Reason::no_lengths ? Reason::no_lengths
                                                                           : Reason::unreachable,
                corrected.error().sentence);
  }
  const auto points = length_points(corrected->grid);
  if (!points) return fail(Reason::no_lengths, points.error().sentence);
  CheckedPart part;
  part.notes = corrected->notes;
  part.points = merged(*points);
  if (part.points.size() > kMostCheckedPoints)
    return too_many(part.points.size(), kMostCheckedPoints, "points");
  part.noise = grid.noise.value_or(StatedNoise{});
  for (const Repeated& one : part.points) part.marks.push_back(one.point.mark);
  if (grid.sheet) {
    part.sheet = observation::SheetPrior{std::max(grid.sheet->shift_mm, kLeastShiftMm),
                                         std::max(1e-3 * grid.sheet->rotation_mrad, kLeastTurnRad)};
    lay(map, part);
  }
  return part;
}

tl::expected<CheckedPart, CheckFailure> part_of(const CompensationMap& map,
                                                const MeasuredHoles& set) {
  if (!set.machine) {
    return fail(
        Reason::no_machine,
        "the holes name no machine; what was commanded becomes chain lengths by its controller");
  }
  MeasuredHoles once = merged(with_true_tape(set));
  if (once.distances.size() > kMostCheckedDistances)
    return too_many(once.distances.size(), kMostCheckedDistances, "distances");
  if (once.holes.size() > kMostCheckedHoles)
    return too_many(once.holes.size(), kMostCheckedHoles, "holes");
  auto distances = observation::TapeDistances::in_given_order(std::move(once));
  if (!distances) return fail(Reason::no_lengths, distances.error().sentence);
  CheckedPart part;
  for (const observation::Place& place : distances->places()) {
    const auto mark = map.inverse(place.lengths);
    if (!mark) {
      return fail(Reason::unreachable,
                  fmt::format("hole {}: {}", place.name, explain(mark.error())));
    }
    part.marks.push_back(*mark);
  }
  part.distances = *std::move(distances);
  // Edges are those of a sheet of its own; distances between holes do not move with it.
  if (std::any_of(set.distances.begin(), set.distances.end(), [](const HoleDistance& distance) {
        return distance.edge.has_value();
      })) {
    part.sheet = observation::SheetPrior{observation::kSheetShiftMm, observation::kSheetTurnRad};
  }
  return part;
}

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
    const auto rows = static_cast<Eigen::Index>(residual_mm_.size());
    const auto chains = 2 * static_cast<Eigen::Index>(at_.lengths.size());
    readings.residual_mm = Eigen::Map<const Eigen::VectorXd>(residual_mm_.data(), rows);
    readings.by_chain.resize(rows, chains);
    readings.by_chain.setFromTriplets(by_chain_.begin(), by_chain_.end());
    ReadingCovariance& covariance = readings.covariance;
    covariance.own = own_;
    covariance.shared.resize(rows, shared_columns_);
    covariance.shared.setFromTriplets(shared_.begin(), shared_.end());
    covariance.of_map = narrowed(readings.by_chain * at_.factor);
    return readings;
  }

 private:
  [[nodiscard]] Eigen::Index row() const { return static_cast<Eigen::Index>(residual_mm_.size()); }

  void add_points(const CheckedPart& part, std::size_t first) {
    const Eigen::Vector3d laid(
        part.placement.x_mm, part.placement.y_mm, part.placement.rotation_rad);
    for (std::size_t i = 0; i < part.points.size(); ++i) {
      const ChainLengths& read = part.points[i].point.lengths;
      const ChainLengths& told = at_.lengths[first + i];
      const Eigen::Matrix2d& by_mark = at_.by_mark[first + i];
      Eigen::MatrixXd own =
          observation::covariance_of({part.noise.length_mm, part.noise.position_mm}, by_mark) /
          part.points[i].count;
      own.diagonal().array() += kLeastVarianceMm2;
      if (!at_.covariance.empty()) own += at_.covariance[first + i];
      own_.push_back(std::move(own));
      const auto chain = 2 * static_cast<Eigen::Index>(first + i);
      for (Eigen::Index side = 0; side < 2; ++side)
        by_chain_.emplace_back(row() + side, chain + side, 1.0);
      Eigen::Vector2d residual(read.left_mm - told.left_mm, read.right_mm - told.right_mm);
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

  /// Where a sheet lies beside where it was meant to: an error that its readings share.
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
      const HoleDistance& distance = set.distances[static_cast<std::size_t>(k)];
      residual_mm_.push_back(residual[k]);
      own_.push_back(Eigen::MatrixXd::Constant(1, 1, std::pow(sigma_of(set, distance), 2)));
      add_hole(geometry, set, before + k, k, first, distance.from);
      if (!distance.edge) add_hole(geometry, set, before + k, k, first, distance.to);
    }
    shared_columns_ +=
        (at_.covariance.empty() ? 2 : 4) * static_cast<Eigen::Index>(set.holes.size());
    add_size_and_hook(set, geometry, before);
    if (!part.sheet) return;
    // A hole's mark on a sheet that moved goes the other way; edges see it, a turn to first order.
    Eigen::Matrix<double, Eigen::Dynamic, 3> by_sheet =
        Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(residual.size(), 3);
    for (Eigen::Index k = 0; k < residual.size(); ++k) {
      const HoleDistance& distance = set.distances[static_cast<std::size_t>(k)];
      if (!distance.edge) continue;
      by_sheet.row(k) =
          -geometry.by_mark.block<1, 2>(k, 2 * static_cast<Eigen::Index>(distance.from)) *
          model::SheetPlacement{}.sensitivity(part.marks[distance.from]);
    }
    add_sheet(*part.sheet, by_sheet, before);
    shared_columns_ += 3;
  }

  /// What one end of a distance sees of the chains at its hole, and of the hole's own error.
  void add_hole(const observation::DistanceGeometry& geometry,
                const MeasuredHoles& set,
                Eigen::Index at_row,
                Eigen::Index distance,
                std::size_t first,
                std::size_t hole) {
    const auto column = 2 * static_cast<Eigen::Index>(hole);
    const Eigen::RowVector2d by_mark = geometry.by_mark.block<1, 2>(distance, column);
    // More read on a chain than the map says for the same place: the tool is nearer to that motor.
    const Eigen::RowVector2d by_chain = -by_mark * at_.by_mark[first + hole].inverse();
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      by_chain_.emplace_back(
          at_row, 2 * static_cast<Eigen::Index>(first) + column + axis, by_chain[axis]);
      shared_.emplace_back(
          at_row, shared_columns_ + column + axis, set.hole_sigma_mm * by_mark[axis]);
    }
    if (at_.covariance.empty()) return;
    // The map's own doubt at the hole, which all of its distances share.
    const Eigen::Matrix2d root = at_.covariance[first + hole].llt().matrixL();
    const Eigen::RowVector2d seen = by_chain * root;
    const auto holes = 2 * static_cast<Eigen::Index>(set.holes.size());
    for (Eigen::Index axis = 0; axis < 2; ++axis)
      shared_.emplace_back(at_row, shared_columns_ + holes + column + axis, seen[axis]);
  }

  void add_size_and_hook(const MeasuredHoles& set,
                         const observation::DistanceGeometry& geometry,
                         Eigen::Index before) {
    const double hook_sigma_mm = set.tape.hook_sigma_mm.value_or(0.0);
    for (Eigen::Index k = 0; k < geometry.by_size.rows(); ++k) {
      for (Eigen::Index axis = 0; axis < 2; ++axis) {
        const double by_size = set.sheet.size_sigma_mm * geometry.by_size(k, axis);
        if (by_size != 0.0) shared_.emplace_back(before + k, shared_columns_ + axis, by_size);
      }
      if (hook_sigma_mm != 0.0)
        shared_.emplace_back(before + k, shared_columns_ + 2, hook_sigma_mm);
    }
    shared_columns_ += hook_sigma_mm != 0.0 ? 3 : 2;
  }

  const MapAt& at_;
  std::vector<double> residual_mm_;
  std::vector<Eigen::MatrixXd> own_;
  Entries by_chain_;
  Entries shared_;
  Eigen::Index shared_columns_ = 0;
};

/// `of` tells files apart where there are several: "", or " of holes.json".
void name_rows(const CheckedPart& part, const std::string& of, CheckReadings& readings) {
  for (const auto& [point, count] : part.points) {
    readings.unit_names.push_back(fmt::format("point {}{}", point.index + 1, of));
    for (const char* side : {"left", "right"})
      readings.names.push_back(fmt::format("point {}{}, {} chain", point.index + 1, of, side));
  }
  if (!part.distances) return;
  for (const HoleDistance& distance : part.distances->set().distances) {
    readings.names.push_back(words_of(part.distances->set(), distance) + of);
    readings.unit_names.push_back(readings.names.back());
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
                                                         const Measured& measured,
                                                         const Progress& progress) {
  const std::vector<MeasuredFile>& files = measured.files();
  std::vector<CheckedPart> parts;
  std::vector<MarkPoint> marks;
  for (const MeasuredFile& file : files) {
    auto part = std::visit([&map](const auto& one) { return part_of(map, one); }, file.measured);
    if (!part) {
      return fail(part.error().reason,
                  (files.size() > 1 ? file.name + ": " : std::string{}) + part.error().sentence);
    }
    marks.insert(marks.end(), part->marks.begin(), part->marks.end());
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
  fill_common(readings, map, *at);
  for (std::size_t k = 0; k < parts.size(); ++k)
    name_rows(parts[k], files.size() > 1 ? " of " + files[k].name : std::string{}, readings);
  for (std::size_t k = 0; k < parts.size(); ++k) {
    for (const std::string& note : parts[k].notes)
      readings.notes.push_back((files.size() > 1 ? files[k].name + ": " : std::string{}) + note);
  }
  return readings;
}

}  // namespace chaintrue::grid
