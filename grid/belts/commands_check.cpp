// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/commands_check.hpp"

#include <array>
#include <cmath>

#include "grid/belts/fit_diagnostics.hpp"
#include "grid/containers.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid {
namespace {

struct ExpectedPlace {
  PerBelt<double> read_mm;
  PerBelt<double> expected_mm;
};

std::vector<ExpectedPlace> expected_places(const MeasuredBelts& belts) {
  std::vector<ExpectedPlace> places;
  for (const BeltPoint& point : belts.points) {
    if (!point.commanded) continue;
    const auto lengths = lengths_at(belts.machine, to_frame(belts.machine, *point.commanded));
    if (lengths) places.push_back({point.lengths_mm, *lengths});
  }
  return places;
}

double typical_mm(const std::vector<ExpectedPlace>& places, const std::vector<BeltPair>& swap) {
  std::vector<double> off;
  for (const ExpectedPlace& place : places) {
    PerBelt<double> read_mm = place.read_mm;
    for (const BeltPair& pair : swap) std::swap(read_mm[pair.first], read_mm[pair.second]);
    for (const Belt belt : kBelts) off.push_back(std::abs(read_mm[belt] - place.expected_mm[belt]));
  }
  return median(off);
}

/// The best exchange, if it is beyond doubt.
std::optional<std::vector<BeltPair>> swapped(const std::vector<ExpectedPlace>& places,
                                             double as_stated_mm) {
  // Near the middle of a frame its belts differ little. A few times the error of readings and
  // anchors in force is beyond doubt if an exchange removes three quarters of it.
  constexpr double kBeyondDoubtMm = 40.0;
  constexpr double kTimesBetter = 4.0;
  if (as_stated_mm < kBeyondDoubtMm) return std::nullopt;
  std::optional<std::vector<BeltPair>> best;
  double least_mm = as_stated_mm / kTimesBetter;
  for (const auto& swap : belt_swaps()) {
    const double typical = typical_mm(places, swap);
    if (typical >= least_mm) continue;
    least_mm = typical;
    best = swap;
  }
  return best;
}

}  // namespace

std::optional<AgainstCommands> against_commands(const MeasuredBelts& belts) {
  if (!belts.machine.anchors_known) return std::nullopt;
  const std::vector<ExpectedPlace> places = expected_places(belts);
  if (places.empty()) return std::nullopt;
  AgainstCommands found;
  found.places = places.size();
  std::vector<double> upper_mm;
  for (const Belt belt : kBelts) {
    std::vector<double> off;
    for (const ExpectedPlace& place : places) {
      off.push_back(place.read_mm[belt] - place.expected_mm[belt]);
      if (is_upper(belt)) upper_mm.push_back(std::abs(off.back()));
    }
    found.median_mm[belt] = median(off);
  }
  found.upper_mm = median(upper_mm);
  found.swapped = swapped(places, typical_mm(places, {}));
  return found;
}

std::optional<OtherFrame> suspected_other_frame(const MeasuredBelts& belts,
                                                const AnchorFit& frame) {
  // Owners measure their frame to a decimetre or two before the first run; another frame is off by
  // more.
  constexpr double kFarMm = 400.0;
  // If the commands contradict the stated anchors too.
  constexpr double kFarWithCommandsMm = 150.0;
  constexpr double kUpperMm = 100.0;
  constexpr double kSigmas = 5.0;
  constexpr std::array kNames = {"tl x", "tl y", "tr x", "tr y", "br x"};
  if (!belts.machine.anchors_known) return std::nullopt;
  const MeasuredBelts untaped = without_distances(belts);
  const FitDiagnostics view(untaped, frame);
  const AnchorVector stated = anchors_of(belts.machine);
  const auto against = against_commands(belts);
  const double upper_mm = against && against->places >= kFewestBeltPoints ? against->upper_mm : 0.0;
  const double far_mm = upper_mm > kUpperMm ? kFarWithCommandsMm : kFarMm;
  std::optional<OtherFrame> found;
  for (const Index i : each_below(kAnchorUnknowns)) {
    const double difference_mm = std::abs(frame.state.anchors[i] - stated[i]);
    const double variance = view.covariance()(i, i);
    if (!(variance > 0.0) || difference_mm < far_mm ||
        difference_mm < kSigmas * std::sqrt(variance))
      continue;
    if (found && difference_mm <= std::abs(found->fitted_mm - found->stated_mm)) continue;
    found = {kNames[as_size(i)], stated[i], frame.state.anchors[i], upper_mm};
  }
  return found;
}

}  // namespace chaintrue::grid
