// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_readings.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "grid/containers.hpp"
#include "grid/estimation/placement_fit.hpp"
#include "grid/failed.hpp"
#include "grid/map/corrected_data.hpp"
#include "grid/map/noise_from_repeats.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/observation.hpp"
#include "grid/observation/tape_distances.hpp"
#include "grid/plane_vectors.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"
#include "model/chains/chain_changes.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {
namespace {

using Entries = std::vector<Eigen::Triplet<double>>;

/// More would take over some ten seconds (docs/reliability.md).
constexpr std::size_t kMostCheckedPoints = 20000;
constexpr std::size_t kMostCheckedDistances = 20000;
constexpr std::size_t kMostCheckedHoles = 500;

/// No workshop reading is more accurate.
constexpr double kLeastVarianceMm2 = observation::kKnownNuisanceMm * observation::kKnownNuisanceMm;

/// Readings at one mark are replaced by their mean.
struct Repeated {
  LengthPoint point;  ///< the first of them, with the mean of all lengths
  double count = 0.0;
};

/// The new points of one file: their positions on the map, and their readings.
struct CheckedPart {
  std::vector<MarkPoint> marks;  ///< on the map
  /// For a newly placed sheet: the accuracy of its placement, and where the readings put it in the
  /// map's frame. Everything is linearised there.
  std::optional<observation::SheetPrior> sheet;
  SheetPlacement placement;
  std::vector<std::string> notes;
  std::vector<Repeated> points;  ///< of a grid
  StatedNoise noise;
  std::optional<observation::TapeDistances> distances;
};

using Reason = CheckFailure::Reason;

/// Sigmas for a sheet with an exact placement: zero has no inverse.
constexpr double kLeastShiftMm = 1e-6;
constexpr double kLeastTurnRad = 1e-9;

std::vector<Repeated> merged(const std::vector<LengthPoint>& points) {
  std::map<std::pair<double, double>, std::size_t> at;
  std::vector<Repeated> result;
  for (const LengthPoint& point : points) {
    const auto [place, is_new] =
        at.emplace(std::pair(point.mark.x_mm, point.mark.y_mm), result.size());
    if (is_new) result.push_back({point, 0.0});
    Repeated& one = result[place->second];
    one.count += 1.0;
    for (const Side side : kSides)
      one.point.lengths[side] += (point.lengths[side] - one.point.lengths[side]) / one.count;
  }
  return result;
}

/// Readings of one distance: their weighted mean.
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
  return failed(
      Reason::too_many_readings,
      fmt::format("{} {} are more than a check accepts ({}); three to five far from each other "
                  "show as much. For a map from all of them, use chaintrue fit",
                  found, what, most));
}

/// The covariance of the mean of a mark's readings.
Matrix2d noise_at(const CheckedPart& part, const Repeated& one, const Matrix2d& by_mark) {
  Matrix2d covariance =
      observation::covariance_of({part.noise.length_mm, part.noise.position_mm}, by_mark) /
      one.count;
  covariance.diagonal().array() += kLeastVarianceMm2;
  return covariance;
}

/// Places the sheet and its marks by the readings and its prior.
void lay(const CompensationMap& map, CheckedPart& part) {
  const auto on_map = [](const SheetPlacement& sheet, const Repeated& one) {
    return model::identity_placement(sheet.to_bed(one.point.mark));
  };
  part.placement = estimation::fit_placement(
      [&](const SheetPlacement& sheet, estimation::PlacementNormal& sum) {
        for (const Repeated& one : part.points) {
          const auto here = map.lengths(on_map(sheet, one));
          if (!here) return false;
          sum.add(difference(one.point.lengths, here->lengths),
                  here->mark_jacobian * sheet.sensitivity(one.point.mark),
                  noise_at(part, one, here->mark_jacobian).inverse());
        }
        return true;
      },
      part.sheet);
  for (const auto i : each_index(part.marks))
    part.marks[i] = on_map(part.placement, part.points[i]);
}

tl::expected<CheckedPart, CheckFailure> checked_part(const CompensationMap& map,
                                                     const MeasuredGrid& grid) {
  MeasuredGrid with_machine = grid;
  if (!with_machine.machine && map.machine() != nullptr) with_machine.machine = *map.machine();
  // A map excludes effects of the paper and of the visit, so the readings must too.
  const auto corrected = corrected_data(with_machine);
  if (!corrected) {
    return failed(corrected.error().reason == FitFailure::Reason::no_lengths ? Reason::no_lengths
                                                                             : Reason::unreachable,
                  corrected.error().sentence());
  }
  const auto points = length_points(corrected->grid);
  if (!points) return failed(Reason::no_lengths, points.error());
  CheckedPart part;
  part.notes = corrected->notes;
  part.points = merged(*points);
  if (part.points.size() > kMostCheckedPoints)
    return too_many(part.points.size(), kMostCheckedPoints, "points");
  part.noise = not_below_rounding(grid.noise.value_or(StatedNoise{}), grid);
  for (const Repeated& one : part.points) part.marks.push_back(one.point.mark);
  if (grid.sheet) {
    part.sheet = observation::SheetPrior{std::max(grid.sheet->shift_mm, kLeastShiftMm),
                                         std::max(1e-3 * grid.sheet->rotation_mrad, kLeastTurnRad)};
    lay(map, part);
  }
  return part;
}

/// Holes are where the map puts the lengths that their controller paid out.
tl::expected<CheckedPart, CheckFailure> checked_part(const CompensationMap& map,
                                                     const MeasuredHoles& set) {
  if (!set.machine) {
    return failed(Reason::no_machine,
                  "the holes have no machine, so the chain lengths for their commands are unknown");
  }
  MeasuredHoles once = merged(with_true_tape(set));
  if (once.distances.size() > kMostCheckedDistances)
    return too_many(once.distances.size(), kMostCheckedDistances, "distances");
  if (once.holes.size() > kMostCheckedHoles)
    return too_many(once.holes.size(), kMostCheckedHoles, "holes");
  auto distances = observation::TapeDistances::in_given_order(std::move(once));
  if (!distances) return failed(Reason::no_lengths, distances.error());
  CheckedPart part;
  for (const observation::Place& place : distances->places()) {
    const auto mark = map.inverse(place.lengths);
    if (!mark) {
      return failed(Reason::unreachable,
                    fmt::format("hole {}: {}", place.name, mark.error().sentence()));
    }
    part.marks.push_back(*mark);
  }
  part.distances = *std::move(distances);
  // Edges belong to their sheet; distances between holes do not depend on it.
  if (any_of(set.distances,
             [](const HoleDistance& distance) { return distance.edge.has_value(); })) {
    part.sheet = observation::kSheetByEdges;
  }
  return part;
}

/// The map at N places of new readings: d(lengths)/d(mark), and the uncertainty of its lengths, one
/// sigma a column, jointly or place by place.
struct MapAt {
  std::vector<MapLengths> here;
  MatrixXd factor;                  ///< F, 2 N x any
  Eigen::SparseMatrix<double> own;  ///< of each place by itself where F has none, 2 N x 2 N
  /// 2 N x p, by the settings of the machine; no columns for a map without one.
  MatrixXd by_parameter;
};

/// Fails if the map has no answer at a mark.
tl::expected<MapAt, CheckFailure> map_at(const CompensationMap& map,
                                         const std::vector<MarkPoint>& marks,
                                         const Progress& progress) {
  const auto count = std::ssize(marks);
  MapAt at;
  const auto* surface = std::get_if<ModelSurface>(&map.contents().surface);
  // A lattice's uncertainty is not linear in the unknowns, so its points are used directly.
  const bool is_joint = surface != nullptr && !surface->lattice;
  at.by_parameter.resize(2 * count, surface != nullptr ? std::ssize(kMachineSettings) : 0);
  at.factor.resize(2 * count, is_joint ? surface->covariance_factor.cols() : 0);
  at.own.resize(2 * count, 2 * count);
  std::optional<ReadingModel> model;
  if (surface != nullptr) model.emplace(surface->machine);
  for (const Index i : each_below(count)) {
    const double share = as_double(i) / as_double(count);
    tell(progress, {"the map at the new points", 1, 2, share});
    const MarkPoint mark = marks[as_size(i)];
    const auto found = map.with_spread(mark);
    if (!found) {
      return failed(Reason::unreachable, fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm, mark.y_mm,
                                                     found.error().sentence()));
    }
    at.here.push_back(found->here);
    if (is_joint) {
      // The rest is what the map's own continuation changes.
      at.factor.middleRows<2>(2 * i) = found->spread_mm.leftCols(at.factor.cols());
    } else {
      const MatrixXd root = linear::covariance_root(map.query(mark)->covariance);
      for (const Index error : {0, 1}) {
        for (const Index side : {0, 1})
          at.own.insert(2 * i + side, 2 * i + error) = root(side, error);
      }
    }
    if (surface == nullptr) continue;
    at.by_parameter.middleRows<2>(2 * i) = observation::lengths_by_setting(
        {*model, surface->sheet}, model->at(surface->sheet.to_bed(mark)).value(), mark,
        {kMachineSettings.begin(), kMachineSettings.end()});
  }
  return at;
}

/// Adds the numbers of a block that are not zero.
void add_block(const MatrixXd& block, Index row, Index column, Entries& entries) {
  for (const Index j : each_below(block.cols())) {
    for (const Index i : each_below(block.rows())) {
      if (block(i, j) != 0.0) entries.emplace_back(row + i, column + j, block(i, j));
    }
  }
}

/// The readings of all parts, row by row. What is sparse is gathered as entries.
class Gathered {
 public:
  explicit Gathered(const MapAt& at) : at_(at) {}

  /// `first` is where the part's places begin among all; `of` distinguishes several files: "", or
  /// " of holes.json".
  void add(const CheckedPart& part, std::size_t first, const std::string& of) {
    const Index before = row();
    const MatrixXd by_sheet =
        part.distances ? add_distances(part, first, of) : add_points(part, first, of);
    if (part.sheet) gather(by_sheet * part.sheet->sigma().asDiagonal(), before);
  }

  CheckReadings readings() && {
    const auto rows = std::ssize(residual_mm_);
    const auto places = std::ssize(at_.here);
    readings_.residual_mm = Eigen::Map<const VectorXd>(residual_mm_.data(), rows);
    readings_.by_length.resize(rows, 2 * places);
    readings_.by_length.setFromTriplets(by_length_.begin(), by_length_.end());
    ReadingCovariance& covariance = readings_.covariance;
    covariance.of_map = narrowed(readings_.by_length * at_.factor);
    Eigen::SparseMatrix<double> errors(rows, error_columns_);
    errors.setFromTriplets(errors_.begin(), errors_.end());
    add_errors(errors, covariance);
    add_errors(readings_.by_length * at_.own, covariance);
    readings_.by_parameter = readings_.by_length * at_.by_parameter;
    readings_.lengths_mm.resize(2 * places);
    for (const Index i : each_below(places))
      readings_.lengths_mm.segment<2>(2 * i) = vector_of(at_.here[as_size(i)].lengths);
    return std::move(readings_);
  }

 private:
  Index row() const { return std::ssize(residual_mm_); }

  /// The rows that were named last are good or bad together.
  void add_unit(std::string name, MatrixXd covariance) {
    const auto rows = as_size(covariance.rows());
    readings_.units.push_back(
        {std::move(name), readings_.units.size(), readings_.names.size() - rows, rows});
    readings_.covariance.own.push_back(std::move(covariance));
  }

  /// Independent errors of the rows from one on, one sigma a column.
  void gather(const MatrixXd& by_error, Index first_row) {
    add_block(by_error, first_row, error_columns_, errors_);
    error_columns_ += by_error.cols();
  }

  // Both return the derivatives of their rows by the sheet's placement.

  MatrixXd add_points(const CheckedPart& part, std::size_t first, const std::string& of) {
    const Vector3d laid(part.placement.x_mm, part.placement.y_mm, part.placement.rotation_rad);
    MatrixXd by_sheet(2 * std::ssize(part.points), 3);
    for (const auto i : each_index(part.points)) {
      const LengthPoint& point = part.points[i].point;
      const auto& [lengths, by_mark] = at_.here[first + i];
      auto by_own_sheet = by_sheet.middleRows<2>(2 * as_index(i));
      by_own_sheet = by_mark * part.placement.sensitivity(point.mark);
      const Vector2d residual = difference(point.lengths, lengths) + by_own_sheet * laid;
      add_block(Matrix2d::Identity(), row(), 2 * as_index(first + i), by_length_);
      append_all(residual_mm_, residual);
      const std::string name = fmt::format("point {}{}", point.index + 1, of);
      for (const char* side : {"left", "right"})
        readings_.names.push_back(fmt::format("{}, {} chain", name, side));
      add_unit(name, noise_at(part, part.points[i], by_mark));
    }
    return by_sheet;
  }

  MatrixXd add_distances(const CheckedPart& part, std::size_t first, const std::string& of) {
    const MeasuredHoles& set = part.distances->set();
    const observation::DistanceGeometry geometry = observation::distance_geometry(set, part.marks);
    const Index before = row(), count = geometry.by_mark.rows();
    append_all(residual_mm_, VectorXd(part.distances->measured() - geometry.predicted_mm));
    for (const HoleDistance& distance : set.distances) {
      readings_.names.push_back(words_of(set, distance) + of);
      add_unit(readings_.names.back(),
               MatrixXd::Constant(1, 1, std::pow(sigma_of(set, distance), 2)));
    }
    // If a sheet moves, a hole's mark on it moves the other way.
    MatrixXd by_sheet = MatrixXd::Zero(count, 3);
    for (const auto hole : each_index(part.marks)) {
      const auto column = 2 * as_index(hole);
      const auto by_mark = geometry.by_mark.middleCols<2>(column);
      // A chain reads more than the map predicts for the place: the tool is nearer to that motor.
      add_block(-by_mark * at_.here[first + hole].mark_jacobian.inverse(), before,
                2 * as_index(first) + column, by_length_);
      by_sheet -= by_mark * SheetPlacement{}.sensitivity(part.marks[hole]);
    }
    gather(set.hole_sigma_mm * geometry.by_mark, before);
    gather(set.sheet.size_sigma_mm * geometry.by_size, before);
    gather(VectorXd::Constant(count, tape_zero_sigma_mm(set.tape)), before);
    return by_sheet;
  }

  const MapAt& at_;
  CheckReadings readings_;
  std::vector<double> residual_mm_;
  Entries by_length_;
  Entries errors_;
  Index error_columns_ = 0;
};

}  // namespace

void add_errors(const Eigen::SparseMatrix<double>& errors, ReadingCovariance& covariance) {
  using At = Eigen::SparseMatrix<double>::InnerIterator;
  Indices unit_of;  // of each row
  Rows first_row;
  for (const MatrixXd& own : covariance.own) {
    first_row.push_back(std::ssize(unit_of));
    unit_of.resize(unit_of.size() + as_size(own.rows()), first_row.size() - 1);
  }
  Index columns = covariance.shared.cols();
  Entries entries;
  for (const Index column : each_below(columns)) {
    for (At at(covariance.shared, column); at; ++at)
      entries.emplace_back(at.row(), column, at.value());
  }
  for (const Index error : each_below(errors.cols())) {
    const std::size_t before = entries.size();
    for (At at(errors, error); at; ++at) entries.emplace_back(at.row(), columns, at.value());
    if (entries.size() == before) continue;
    const std::size_t unit = unit_of[as_size(entries[before].row())];
    if (unit != unit_of[as_size(entries.back().row())]) {
      ++columns;
      continue;
    }
    entries.resize(before);
    MatrixXd& own = covariance.own[unit];
    const VectorXd part = errors.block(first_row[unit], error, own.rows(), 1);
    own += part * part.transpose();
  }
  covariance.shared.resize(covariance.rows(), columns);
  covariance.shared.setFromTriplets(entries.begin(), entries.end());
}

tl::expected<CheckReadings, CheckFailure> check_readings(const CompensationMap& map,
                                                         const Measured& measured,
                                                         const Progress& progress) {
  const std::vector<MeasuredFile>& files = measured.files();
  const auto head_of = [&files](const MeasuredFile& file) {
    return files.size() > 1 ? file.name + ": " : std::string{};
  };
  std::vector<CheckedPart> parts;
  std::vector<MarkPoint> marks;
  for (const MeasuredFile& file : files) {
    auto part =
        std::visit([&map](const auto& one) { return checked_part(map, one); }, file.measured);
    if (!part) {
      return failed(part.error().reason, head_of(file) + part.error().sentence());
    }
    append_all(marks, part->marks);
    parts.push_back(*std::move(part));
  }
  const auto at = map_at(map, marks, progress);
  if (!at) return failed(at);
  Gathered gathered(*at);
  std::size_t first = 0;
  for (const auto k : each_index(parts)) {
    gathered.add(parts[k], first, files.size() > 1 ? " of " + files[k].name : std::string{});
    first += parts[k].marks.size();
  }
  CheckReadings readings = std::move(gathered).readings();
  constexpr double kUsualPitchMm = 6.35;
  readings.changes = map.machine() != nullptr ? ReadingModel(*map.machine()).possible_changes()
                                              : model::changes_of_chains(kUsualPitchMm);
  const ChainLengths zero = map.machine() != nullptr ? map.machine()->chain_zero : ChainLengths{};
  readings.zero_mm = {zero.left_mm, zero.right_mm};
  for (const auto k : each_index(parts)) {
    for (const std::string& note : parts[k].notes)
      readings.notes.push_back(head_of(files[k]) + note);
  }
  return readings;
}

}  // namespace chaintrue::grid
