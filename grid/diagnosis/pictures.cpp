// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/findings.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// The values of every unit in the pictures, whitened, all rows.
struct Residuals {
  VectorXd before;  ///< of the calibrated machine
  VectorXd after;   ///< with the causes named
  VectorXd best;    ///< what the best cause explains, settings refitted
  VectorXd rival;
};

Residuals residuals_of(const Analysis& a) {
  const auto of_machine = [&](const RegressorSet& regressors) {
    const Estimate fitted = estimate_of(a, regressors);
    return left_of_machine(a.system, fitted, fitted.left);
  };
  const Shown sets = shown(a);
  Residuals result;
  result.before = of_machine({});
  result.after = left_of_machine(a.system, a.estimate, a.estimate.left);
  result.best = result.before - of_machine(sets.best);
  result.rival = result.before - of_machine(sets.rival);
  return result;
}

PointPicture picture_of(const Analysis& a, const Residuals& residuals, std::size_t u) {
  const SystemUnit& unit = a.system.units[u];
  const std::size_t at = unit.places.front().place;
  const SystemPlace& state = a.system.places[at];
  const NumberedPlace& place = a.session.places[at];
  PointPicture p;
  p.index = place.index;
  p.mark = place.mark;
  if (state.ordered) p.order = place.order;
  p.bad = marginalised_system(a).outliers[u];
  p.chain_before_mm = unit.unwhitened(residuals.before);
  p.chain_after_mm = unit.unwhitened(residuals.after);
  p.before_mm = tool_shift(state, p.chain_before_mm);
  p.after_mm = tool_shift(state, p.chain_after_mm);
  p.noise_sigma_mm = noise_of_unit_mm2(a.system, u).diagonal().cwiseSqrt();
  p.best_mm = unit.unwhitened(residuals.best);
  p.rival_mm = unit.unwhitened(residuals.rival);
  p.lengths = place.lengths;
  const model::Pose& pose = state.state.reading.pose;
  p.angle_left_rad = pose.chains.left.angle_rad;
  p.angle_right_rad = pose.chains.right.angle_rad;
  p.tension_left_n = pose.chains.left.tension_at_sprocket_n;
  p.tension_right_n = pose.chains.right.tension_at_sprocket_n;
  if (!state.ordered) return p;
  const bool first = at == a.session.parts[place.part].first_place;
  const auto& last = first ? pose.lengths : a.system.places[at - 1].state.reading.pose.lengths;
  p.direction_left = pose.lengths.left_mm < last.left_mm ? -1 : 1;
  p.direction_right = pose.lengths.right_mm < last.right_mm ? -1 : 1;
  return p;
}

DistancePicture picture_of(const Analysis& a, const Residuals& residuals, const TapeDistances& tape,
                           std::size_t k, std::size_t u) {
  const MeasuredHoles& set = tape.set();
  const HoleDistance& distance = set.distances[k];
  const auto mm = [&](const VectorXd& whitened) {
    return error_of_unit(a.system, whitened, u).x();
  };
  DistancePicture picture;
  picture.index = a.session.units[u].index;
  picture.from = set.holes[distance.from].name;
  picture.to =
      distance.edge ? std::string(grid::name(*distance.edge)) : set.holes[distance.to].name;
  picture.bad = marginalised_system(a).outliers[u];
  picture.read_mm = length_of(set, distance);
  picture.before_mm = mm(residuals.before);
  picture.after_mm = mm(residuals.after);
  picture.noise_sigma_mm = std::sqrt(noise_of_unit_mm2(a.system, u)(0, 0));
  picture.best_mm = mm(residuals.best);
  picture.rival_mm = mm(residuals.rival);
  return picture;
}

}  // namespace

std::string words_of_ends(const DistancePicture& distance) {
  return any_of(kSheetEdges, [&](SheetEdge edge) { return grid::name(edge) == distance.to; })
             ? fmt::format("{} to the {} edge", distance.from, distance.to)
             : fmt::format("{}-{}", distance.from, distance.to);
}

std::vector<PointPicture> point_pictures(const Analysis& a) {
  if (!a.session.reads_chains()) return {};
  const Residuals residuals = residuals_of(a);
  std::vector<PointPicture> result;
  for (const auto u : each_index(a.system.units)) {
    if (a.system.units[u].reads_chains) result.push_back(picture_of(a, residuals, u));
  }
  sort(result, ascending(&PointPicture::index));
  return result;
}

std::vector<HolePicture> hole_pictures(const Analysis& a) {
  const State state =
      with_settings(a.session, a.state, a.system.setting + a.estimate.setting_change);
  std::map<std::size_t, HolePicture> by_index;
  for (const auto& [part, tape] : parts_of<TapeDistances>(a.session)) {
    const auto places = tape->placed(state.view(*part));
    for (const auto i : each_index(tape->places())) {
      const Place& hole = tape->places()[i];
      by_index[hole.index] = {hole.name, hole.mark, places ? (*places)[i].mark : hole.mark};
    }
  }
  std::vector<HolePicture> result;
  for (auto& [index, picture] : by_index) result.push_back(std::move(picture));
  return result;
}

std::vector<DistancePicture> distance_pictures(const Analysis& a) {
  if (!a.session.has_distances()) return {};
  const Residuals residuals = residuals_of(a);
  std::vector<DistancePicture> result;
  for (const auto& [part, tape] : parts_of<TapeDistances>(a.session)) {
    for (const auto k : each_index(tape->units())) {
      result.push_back(picture_of(a, residuals, *tape, k, part->first_unit + k));
    }
  }
  sort(result, ascending(&DistancePicture::index));
  return result;
}

}  // namespace chaintrue::grid::diagnosis
