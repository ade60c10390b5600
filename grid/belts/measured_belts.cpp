// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/measured_belts.hpp"

#include <fmt/format.h>

#include <set>

namespace chaintrue::grid {

std::vector<Belt> pulled_after(model::Orientation orientation, BedPoint from, BedPoint to,
                               std::size_t visit) {
  constexpr std::size_t kFirstRound = 6;
  // The firmware's own threshold.
  constexpr double kMovedMm = 1.0;
  const double right = to.x_mm - from.x_mm;
  const double up = to.y_mm - from.y_mm;
  if (orientation == model::Orientation::upright || visit < kFirstRound)
    return {Belt::bl, Belt::br};
  if (right > kMovedMm) return {Belt::tl, Belt::bl};
  if (right < -kMovedMm) return {Belt::tr, Belt::br};
  if (up < -kMovedMm) return {Belt::tl, Belt::tr};
  return {Belt::bl, Belt::br};
}

MeasuredBelts without_distances(MeasuredBelts belts) {
  belts.distances.clear();
  return belts;
}

bool is_pulled(const BeltPoint& point, Belt belt) {
  if (!point.pulled) return !is_upper(belt);
  return contains(*point.pulled, belt);
}

PerBelt<bool> pulled_belts(const BeltPoint& point) {
  PerBelt<bool> pulled;
  for (const Belt belt : kBelts) pulled[belt] = is_pulled(point, belt);
  return pulled;
}

std::optional<BeltPull> reference_pull(const MeasuredBelts& belts) {
  if (belts.reference_pull) return belts.reference_pull;
  std::optional<BeltPull> least;
  for (const BeltPoint& point : belts.points) {
    if (point.pull && (!least || point.pull->value < least->value)) least = point.pull;
  }
  return least;
}

double pull_over(const std::optional<BeltPull>& reference, const BeltPoint& point) {
  return reference && point.pull ? point.pull->value / reference->value : 1.0;
}

std::vector<double> different_pulls(const MeasuredBelts& belts) {
  const std::optional<BeltPull> reference = reference_pull(belts);
  std::set<double> different;
  for (const BeltPoint& point : belts.points) different.insert(pull_over(reference, point));
  return {different.begin(), different.end()};
}

std::string words_of(const BeltPull& pull) {
  return fmt::format("{:g} {}", pull.value, word_of(pull.unit, {"times", "N", "mA"}));
}

std::string words_of(const BeltEnd& end) {
  if (const auto* index = std::get_if<std::size_t>(&end))
    return fmt::format("point {}", *index + 1);
  if (const auto* belt = std::get_if<Belt>(&end)) {
    return fmt::format("the {} anchor", words(*belt));
  }
  const BedPoint at = std::get<CutHole>(end).commanded;
  return fmt::format("the hole at ({:g}, {:g})", at.x_mm, at.y_mm);
}

}  // namespace chaintrue::grid
