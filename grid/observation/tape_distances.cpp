// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/observation/tape_distances.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "grid/failed.hpp"
#include "grid/plane_vectors.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"
#include "model/controllers/payout.hpp"
#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid::observation {
namespace {

/// A set in an order that the file's does not change.
struct Sorted {
  MeasuredHoles set;
  Indices hole;      ///< into the given set's
  Indices distance;  ///< into the given set's
};

/// Holes by place and distances by their holes.
Sorted sorted_set(const MeasuredHoles& set) {
  Sorted result{set, numbers_below(set.holes.size()), numbers_below(set.distances.size())};
  sort(result.hole, ascending([&](std::size_t i) {
         const Hole& own = set.holes[i];
         return std::tie(own.commanded.x_mm, own.commanded.y_mm, own.name);
       }));
  Indices place(set.holes.size());
  for (const auto i : each_index(result.hole)) {
    place[result.hole[i]] = i;
    result.set.holes[i] = set.holes[result.hole[i]];
  }
  const auto key = [&](std::size_t k) {
    const HoleDistance& d = set.distances[k];
    const std::size_t a = place[d.from];
    const std::size_t b = d.edge ? a : place[d.to];
    return std::tuple(std::min(a, b), std::max(a, b), d.edge, d.distance_mm, sigma_of(set, d));
  };
  stable_sort(result.distance, ascending(key));
  for (const auto k : each_index(result.distance)) {
    HoleDistance own = set.distances[result.distance[k]];
    own.from = place[own.from];
    if (!own.edge) own.to = place[own.to];
    result.set.distances[k] = own;
  }
  return result;
}

/// The one effect of the paper that a tape can have: its scale.
bool is_of_tape(const Effect& effect, EffectSide side) {
  if (effect.station != Station::paper || side != EffectSide::both) return false;
  // Declared effects may be more than a scale.
  const std::vector<double> values = nominal_values(effect);
  const MarkPoint x = effect.write({1.0, 0.0}, side, values);
  const MarkPoint y = effect.write({0.0, 1.0}, side, values);
  return x.y_mm == 0.0 && y.x_mm == 0.0 && x.x_mm == y.y_mm;
}

}  // namespace

const Kind tape_distances{"tape_distances", "distance", "distances", "hole", false};

DistanceGeometry distance_geometry(const MeasuredHoles& set, const std::vector<MarkPoint>& marks) {
  const auto count = std::ssize(set.distances);
  DistanceGeometry geometry{VectorXd::Zero(count), MatrixXd::Zero(count, 2 * std::ssize(marks)),
                            MatrixXd::Zero(count, 2)};
  for (const Index k : each_below(count)) {
    const HoleDistance& distance = set.distances[as_size(k)];
    const MarkPoint from = marks.at(distance.from);
    const auto a = 2 * as_index(distance.from);
    if (distance.edge) {
      const EdgeLine line = edge_line(set, *distance.edge);
      geometry.predicted_mm[k] = 0.5 * line.size_mm + line.sign * vector_of(from)[line.axis];
      geometry.by_mark(k, a + line.axis) = line.sign;
      // Half of the sheet's excess size is at each edge.
      geometry.by_size(k, line.axis) = 0.5;
      continue;
    }
    const MarkPoint to = marks.at(distance.to);
    const auto b = 2 * as_index(distance.to);
    const Vector2d way = difference(from, to);
    geometry.predicted_mm[k] = way.norm();
    const Vector2d unit = way / way.norm();
    geometry.by_mark.block<1, 2>(k, a) = unit.transpose();
    geometry.by_mark.block<1, 2>(k, b) = -unit.transpose();
  }
  return geometry;
}

DistanceNoise distance_noise(const MeasuredHoles& set, const DistanceGeometry& geometry) {
  const Index count = geometry.predicted_mm.size();
  DistanceNoise noise;
  noise.tape_mm2.resize(count);
  for (const Index k : each_below(count)) {
    noise.tape_mm2[k] = std::pow(sigma_of(set, set.distances[as_size(k)]), 2);
  }
  noise.holes_mm2 = std::pow(set.hole_sigma_mm, 2) * linear::outer(geometry.by_mark);
  noise.size_mm2 = std::pow(set.sheet.size_sigma_mm, 2) * linear::outer(geometry.by_size);
  noise.tape_zero_mm2 = MatrixXd::Constant(count, count, std::pow(tape_zero_sigma_mm(set.tape), 2));
  return noise;
}

/// A reading is no more accurate than its last digit.
void raise_to_rounding(MeasuredHoles& set) {
  const double least_mm = rounding_sigma_mm(mapped(set.distances, &HoleDistance::distance_mm));
  set.tape.sigma_mm = std::max(set.tape.sigma_mm, least_mm);
  for (HoleDistance& distance : set.distances) {
    if (distance.sigma_mm) distance.sigma_mm = std::max(*distance.sigma_mm, least_mm);
  }
}

double tape_factor(const Machine& machine) {
  double factor = 1.0;
  for (const model::effects::ActingEffect& acting : model::effects::acting_effects(machine)) {
    if (!is_of_tape(*acting.effect, acting.side)) continue;
    factor *= acting.effect->write({1.0, 0.0}, acting.side, acting.values).x_mm;
  }
  return factor;
}

SheetPrior sheet_measured(const MeasuredHoles& set) {
  // Two readings to upright edges, from holes this far apart in height, determine the rotation.
  constexpr double kApartMm = 100.0;
  SheetPrior measured = kSheetByEdges;
  measured.knows_x = measured.knows_y = measured.knows_rotation = false;
  for (const HoleDistance& a : set.distances) {
    if (!a.edge) continue;
    const Index axis = edge_line(set, *a.edge).axis;
    (axis == 0 ? measured.knows_x : measured.knows_y) = true;
    for (const HoleDistance& b : set.distances) {
      if (!b.edge || edge_line(set, *b.edge).axis != axis) continue;
      const Vector2d apart =
          difference(set.holes.at(a.from).commanded, set.holes.at(b.from).commanded);
      if (std::abs(apart[1 - axis]) > kApartMm) measured.knows_rotation = true;
    }
  }
  return measured;
}

tl::expected<TapeDistances, std::string> TapeDistances::in_given_order(MeasuredHoles set) {
  if (!set.machine) throw std::invalid_argument("holes without a machine predict no distances");
  raise_to_rounding(set);
  TapeDistances result(std::move(set));
  const auto controller = make_controller_kinematics(*result.set_.machine);
  for (const auto i : each_index(result.set_.holes)) {
    const Hole& hole = result.set_.holes[i];
    const auto lengths = controller->lengths(hole.commanded);
    if (!lengths) {
      return tl::unexpected(
          fmt::format("the controller cannot reach hole {} at ({:.1f}, {:.1f}): {}", hole.name,
                      hole.commanded.x_mm, hole.commanded.y_mm, lengths.error().sentence()));
    }
    result.places_.push_back(
        {i, hole.name, identity_placement(hole.commanded), *lengths, as_int(i)});
  }
  const std::size_t count = result.set_.distances.size();
  result.measured_.resize(as_index(count));
  for (const std::size_t k : each_below(count)) {
    const auto row = as_index(k);
    result.measured_[row] = length_of(result.set_, result.set_.distances[k]);
    result.units_.push_back({row, 1, k});
  }
  result.sheet_ = sheet_measured(result.set_);
  const MeasuredHoles& own = result.set_;
  const Index of_holes = 2 * std::ssize(own.holes);
  result.nuisance_sigma_.resize(3 + of_holes);
  result.nuisance_sigma_ << own.sheet.size_sigma_mm, own.sheet.size_sigma_mm,
      tape_zero_sigma_mm(own.tape), VectorXd::Constant(of_holes, own.hole_sigma_mm);
  result.nuisance_sigma_ = result.nuisance_sigma_.cwiseMax(kKnownNuisanceMm);
  return result;
}

tl::expected<TapeDistances, std::string> TapeDistances::of(const MeasuredHoles& set,
                                                           NumberedFrom first) {
  const Sorted sorted = sorted_set(set);
  auto result = in_given_order(sorted.set);
  if (!result) return result;
  for (Place& place : result->places_) place.index = first.hole + sorted.hole[place.index];
  for (Unit& unit : result->units_) unit.index = first.distance + sorted.distance[unit.index];
  return result;
}

tl::expected<Linearisation, Unreachable> TapeDistances::linearise(const View& view,
                                                                  const Columns& columns) const {
  const std::vector<Setting> settings = settings_in(columns);
  auto states = placed(view);
  if (!states) return failed(states);
  const auto marks = mapped(*states, &ChainPlaceState::mark);
  const double factor = tape_factor(view.chains().machine());
  const DistanceGeometry geometry = distance_geometry(set_, marks);
  const MatrixXd by_mark = factor * geometry.by_mark;
  Linearisation line = blank(std::ssize(settings));
  line.predicted = factor * geometry.predicted_mm;
  for (const auto i : each_index(*states)) {
    const ChainPlaceState& place = (*states)[i];
    // f(sheet(m), settings) = l holds: dm = -(df/dm)^-1 df/ds ds
    const Matrix2Xd lengths = place.by_length.asDiagonal() *
                              lengths_by_setting(view, place.reading, place.mark, settings);
    const Matrix2Xd marks_by_setting = -place.by_mark.inverse() * lengths;
    line.by_setting += by_mark.middleCols<2>(2 * as_index(i)) * marks_by_setting;
  }
  line.by_nuisance << factor * geometry.by_size, VectorXd::Ones(rows()), by_mark;
  for (const Index k : each_below(rows())) {
    const double sigma = sigma_of(set_, set_.distances[as_size(k)]);
    UnitState unit{MatrixXd::Constant(1, 1, sigma * sigma), {}};
    for (const auto i : each_index(*states)) {
      const RowVector2d own = by_mark.block<1, 2>(k, 2 * as_index(i));
      if (!own.isZero(0.0)) unit.places.push_back({i, -own * (*states)[i].by_mark.inverse()});
    }
    line.units.push_back(std::move(unit));
  }
  line.places = std::move(*states);
  return line;
}

std::string TapeDistances::untestable(const Effect& effect, EffectSide side) const {
  if (effect.needs == DataNeed::order) {
    return "the order in which the holes were cut is not in the file, and no chain was read";
  }
  if (effect.station == Station::paper && !is_of_tape(effect, side)) {
    return "a tape has one scale in every direction, and no axes: print or place marks and read "
           "the chains there";
  }
  return "";
}

std::string TapeDistances::name_of(std::size_t unit) const {
  return "the distance " + words_of(set_, set_.distances.at(unit));
}

tl::expected<std::vector<ChainPlaceState>, Unreachable> TapeDistances::placed(
    const View& view) const {
  // A correction changes by a thousandth of a hole's shift and the chains' scale is below 0.2 %:
  // each iteration gains at least two digits, starting within some mm.
  constexpr int kTurns = 6;
  constexpr double kConvergedMm = 1e-9;
  std::vector<ChainPlaceState> states;
  for (const auto i : each_index(places_)) {
    const ChainLengths paid_out = places_[i].lengths;
    MarkPoint mark = places_[i].mark;
    ChainLengths own = paid_out;
    // The machine's lengths that equal the paid-out ones after correction at a mark.
    const auto correct = [&] {
      const auto there = view.corrected(mark, own, Matrix2d::Zero()).lengths;
      own = {paid_out.left_mm - (there.left_mm - own.left_mm),
             paid_out.right_mm - (there.right_mm - own.right_mm)};
    };
    correct();
    auto reading = view.chains().find(own, identity_placement(mark));
    for (int turn = 1; reading && turn < kTurns; ++turn) {
      const ChainLengths before = own;
      mark = view.sheet.to_mark(reading->pose.position);
      correct();
      if (difference(own, before).lpNorm<1>() < kConvergedMm) break;
      reading = view.chains().find(own, reading->pose.position);
    }
    if (!reading) return tl::unexpected(mechanism_failure(reading.error()).at(i));
    states.push_back(place_state(view, *reading, view.sheet.to_mark(reading->pose.position)));
  }
  return states;
}

}  // namespace chaintrue::grid::observation
