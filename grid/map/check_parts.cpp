// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/map/check_parts.hpp"

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
#include "grid/observation/observation.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid {
namespace {

using model::MarkPoint;

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
    one.point.lengths.left_mm += (point.lengths.left_mm - one.point.lengths.left_mm) / one.count;
    one.point.lengths.right_mm += (point.lengths.right_mm - one.point.lengths.right_mm) / one.count;
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
                  found,
                  what,
                  most));
}

/// Places the sheet and its marks by the readings and its prior.
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

}  // namespace

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
  if (!points) return failed(Reason::no_lengths, points.error().sentence());
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
  if (!distances) return failed(Reason::no_lengths, distances.error().sentence());
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
    part.sheet = observation::SheetPrior{observation::kSheetShiftMm, observation::kSheetTurnRad};
  }
  return part;
}

namespace {

constexpr auto& kOfMachine = model::kMachineSettings;

tl::unexpected<CheckFailure> no_answer(std::string sentence) {
  return failed(CheckReason::unreachable, std::move(sentence));
}

/// Columns of d(lengths)/d(settings) at a mark, in the order of the surface's settings.
std::optional<Eigen::MatrixXd> design_at(const ModelSurface& surface,
                                         const model::ReadingModel& model,
                                         model::MarkPoint mark,
                                         Eigen::Matrix2Xd& by_parameter) {
  const observation::View view{model, surface.sheet};
  const auto reading = model.at(surface.sheet.to_bed(mark));
  if (!reading) return std::nullopt;
  by_parameter =
      observation::lengths_by_setting(view, *reading, mark, {kOfMachine.begin(), kOfMachine.end()});
  return design_rows(surface.residual.basis,
                     surface.columns,
                     mark,
                     reading->lengths,
                     observation::lengths_by_setting(view, *reading, mark, surface.settings));
}

}  // namespace

tl::expected<MapAt, CheckFailure> map_at(const CompensationMap& map,
                                         const std::vector<model::MarkPoint>& marks,
                                         const Progress& progress) {
  const auto count = std::ssize(marks);
  MapAt at;
  const auto* surface = std::get_if<ModelSurface>(&map.contents().surface);
  // A lattice's uncertainty is not linear in the unknowns, so its points are used directly.
  const bool is_joint = surface != nullptr && !surface->lattice;
  at.by_parameter.resize(2 * count, surface != nullptr ? std::ssize(kOfMachine) : 0);
  Eigen::MatrixXd design(2 * count, is_joint ? surface->columns.total() : 0);
  std::optional<model::ReadingModel> model;
  if (surface != nullptr) model.emplace(surface->machine);
  for (Eigen::Index i = 0; i < count; ++i) {
    const double share = as_double(i) / as_double(count);
    tell(progress, {"the map at the new points", 1, 2, share});
    const model::MarkPoint mark = marks[as_size(i)];
    const auto refused = [&mark](const MapFailure& failure) {
      return no_answer(
          fmt::format("({:.1f}, {:.1f}): {}", mark.x_mm, mark.y_mm, failure.sentence()));
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
    Eigen::Matrix2Xd by_parameter;
    const auto rows = design_at(*surface, *model, mark, by_parameter);
    if (!rows) {
      return no_answer(fmt::format(
          "({:.1f}, {:.1f}): the calibrated machine has no pose there", mark.x_mm, mark.y_mm));
    }
    at.by_parameter.middleRows(2 * i, 2) = by_parameter;
    if (is_joint) design.middleRows(2 * i, 2) = *rows;
  }
  at.factor = is_joint ? Eigen::MatrixXd(design * surface->covariance_factor)
                       : Eigen::MatrixXd(2 * count, 0);
  return at;
}

}  // namespace chaintrue::grid
