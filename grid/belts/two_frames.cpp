// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/two_frames.hpp"

#include <algorithm>

#include "grid/belts/anchor_estimate.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {
namespace {

/// Real frames have smaller residuals.
constexpr double kOneFrameMm = 3.0;
/// Each of two frames has at most this residual.
constexpr double kMostOfAFrameMm = 15.0;
/// An anchor that was relocated; one that gave way moves by millimetres.
constexpr double kStandsElsewhereMm = 25.0;
/// Each of two frames fits this many times better than both together.
constexpr double kBetterApart = 4.0;
/// This many points determine a frame as well as all do.
constexpr std::size_t kMostOfAPart = 24;

/// Points from `first` to before `end`, evenly thinned, both ends kept.
MeasuredBelts evenly_of(const MeasuredBelts& belts, std::size_t first, std::size_t end) {
  MeasuredBelts part = belts;
  part.distances.clear();
  part.points.clear();
  const std::size_t count = end - first;
  const std::size_t taken = std::min(count, kMostOfAPart);
  for (const std::size_t i : each_below(taken)) {
    const std::size_t at = taken > 1 ? i * (count - 1) / (taken - 1) : 0;
    part.points.push_back(belts.points[first + at]);
  }
  return part;
}

std::optional<AnchorFit> fitted_frame(const MeasuredBelts& belts, std::size_t first,
                                      std::size_t end) {
  auto fitted = belts::fit_anchors(evenly_of(belts, first, end));
  return fitted && fitted->is_sound ? std::optional(*std::move(fitted)) : std::nullopt;
}

/// The larger residual [mm] of two fits: to the points before `end`, and to those from `begin` on. Infinite if
/// either fit is unsound, or if both place the anchors alike: slipping belts and yielding anchors are left to
/// the diagnosis.
double apart_mm(const MeasuredBelts& belts, std::size_t end, std::size_t begin) {
  const auto before = fitted_frame(belts, 0, end);
  const auto after = fitted_frame(belts, begin, belts.points.size());
  if (!before || !after) return kInfinity;
  // tl x and y, tr x and y, br x
  const AnchorVector moved = (after->state.anchors - before->state.anchors).cwiseAbs();
  const int anchors = (moved.segment<2>(0).maxCoeff() > kStandsElsewhereMm) +
                      (moved.segment<2>(2).maxCoeff() > kStandsElsewhereMm) +
                      (moved[4] > kStandsElsewhereMm);
  if (anchors < 2) return kInfinity;
  return std::max(before->residual_sigma_mm, after->residual_sigma_mm);
}

}  // namespace

std::optional<std::size_t> second_frame_begins(const MeasuredBelts& belts) {
  const std::size_t count = belts.points.size();
  if (count < 2 * kFewestBeltPoints) return std::nullopt;
  const auto together = fitted_frame(belts, 0, count);
  const double together_mm = together ? together->residual_sigma_mm : kInfinity;
  if (together_mm < kOneFrameMm) return std::nullopt;
  const std::size_t last = count - kFewestBeltPoints;
  std::size_t best = 0;
  double least_mm = std::min(kMostOfAFrameMm, together_mm / kBetterApart);
  const auto before = [](std::size_t at, std::size_t gap) {
    return at > kFewestBeltPoints + gap ? at - gap : kFewestBeltPoints;
  };
  const auto try_at = [&](std::size_t at, std::size_t gap) {
    const double own_mm = apart_mm(belts, before(at, gap), std::min(at + gap, last));
    if (!(own_mm < least_mm)) return;
    least_mm = own_mm;
    best = at;
  };
  // First coarsely, leaving a gap so that neither part contains points of the other frame; then exactly.
  constexpr std::size_t kSplits = 32;
  const std::size_t step = 1 + (last - kFewestBeltPoints) / kSplits;
  for (std::size_t at = kFewestBeltPoints; at <= last; at += step) try_at(at, step - 1);
  if (best == 0) return std::nullopt;
  const std::size_t coarse = best;
  least_mm = kMostOfAFrameMm;
  for (std::size_t at = before(coarse, step - 1); at < coarse + step && at <= last; ++at)
    try_at(at, 0);
  return best;
}

}  // namespace chaintrue::grid
