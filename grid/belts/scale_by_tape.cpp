// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/scale_by_tape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "grid/belts/fit_diagnostics.hpp"
#include "grid/containers.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {
namespace {

constexpr int kDirections = 8;
/// Holes are proposed at multiples of ten, which are easy to type.
constexpr double kWholeMm = 10.0;

/// The outermost points of the file in each direction, each once.
Indices outermost(const BeltsFit& fit) {
  Indices points;
  for (const int i : each_below(kDirections)) {
    const double angle = 2.0 * std::numbers::pi * (i + 0.5) / kDirections;
    const auto along = [&](const FittedPlace& place) {
      return std::cos(angle) * place.at.x_mm + std::sin(angle) * place.at.y_mm;
    };
    const auto most = max_element(fit.places, ascending(along));
    const auto index = as_size(most - fit.places.begin());
    const bool bad = contains(fit.bad_points, index);
    if (!bad && !contains(points, index)) points.push_back(index);
  }
  return points;
}

/// Where a tape may end.
std::vector<BeltEnd> ends_of(const MeasuredBelts& belts, const BeltsFit& fit) {
  std::vector<BeltEnd> ends;
  for (const std::size_t index : outermost(fit)) {
    if (!belts.machine.anchors_known) {
      ends.emplace_back(index);
      continue;
    }
    const FramePoint centre = centre_of(belts.machine);
    const auto whole = [](double mm) { return kWholeMm * std::round(mm / kWholeMm) + 0.0; };
    ends.emplace_back(CutHole{{whole(fit.places[index].at.x_mm - centre.x_mm),
                               whole(fit.places[index].at.y_mm - centre.y_mm)}});
  }
  return ends;
}

AnchorFit frame_of(const BeltsFit& fit) {
  AnchorFit frame;
  frame.state.anchors = anchors_of(fit.machine);
  for (const FittedPlace& place : fit.places) {
    frame.state.places.push_back(place.at);
    PerBelt<bool>& counts = frame.counting.emplace_back();
    for (const Belt belt : kBelts) counts[belt] = place.belts[belt].counts;
  }
  if (fit.scale) frame.state.log_scale = std::log(fit.scale->factor);
  // Lengths without noise are given a hundredth of a usual sigma.
  constexpr double kFinestMm = 1e-3;
  frame.residual_sigma_mm = std::max(fit.residual_sigma_mm, kFinestMm);
  return frame;
}

/// One sigma of the scale with this distance as well; infinity if it is not determined.
double sigma_with(const MeasuredBelts& belts, const FitDiagnostics& view, BeltDistance& distance) {
  const auto expected = view.expected(belts, distance);
  if (!expected || !(expected->mm > 0.0)) return kInfinity;
  distance.distance_mm = expected->mm;
  const double noise = distance.sigma_mm * distance.sigma_mm + expected->variance_mm2;
  // The first distance determines the scale alone.
  if (!view.has_scale()) return std::sqrt(noise) / expected->mm;
  const double known = view.covariance()(kAnchorUnknowns, kAnchorUnknowns);
  const double left = known - expected->with_scale * expected->with_scale / noise;
  return left > 0.0 ? std::sqrt(left) : kInfinity;
}

}  // namespace

std::optional<DistanceForScale> distance_for_scale(const MeasuredBelts& belts,
                                                   const BeltsFit& fit) {
  if (fit.places.empty()) return std::nullopt;
  std::vector<std::pair<BeltEnd, BeltEnd>> pairs;
  const auto add_pairs = [&pairs](const std::vector<BeltEnd>& ends) {
    for (const auto i : each_index(ends)) {
      for (std::size_t j = i + 1; j < ends.size(); ++j) pairs.emplace_back(ends[i], ends[j]);
    }
  };
  add_pairs({kBelts.begin(), kBelts.end()});
  add_pairs(ends_of(belts, fit));
  const FitDiagnostics view(belts, frame_of(fit));
  std::optional<DistanceForScale> best;
  for (const auto& [from, to] : pairs) {
    BeltDistance distance{from, to, 0.0, kTapedDistanceMm};
    const double sigma = sigma_with(belts, view, distance);
    // A gain of 1 % does not justify drilling a hole if two anchors serve.
    constexpr double kBetter = 0.99;
    if (std::isfinite(sigma) && (!best || sigma < kBetter * best->sigma))
      best = DistanceForScale{distance, sigma};
  }
  return best;
}

}  // namespace chaintrue::grid
