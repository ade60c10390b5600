// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/two_frames.hpp"

#include <algorithm>

#include "grid/belts/anchor_estimate.hpp"

namespace chaintrue::grid {
namespace {

/// Frames of real machines contradict themselves by 3 mm at most; two frames in one by hundreds.
constexpr double kOneFrameMm = 15.0;
/// As many points of a part tell a frame as well as all.
constexpr std::size_t kMostOfAPart = 24;

/// Points from `first` to before `end`, every so manieth with the two ends.
MeasuredBelts evenly_of(const MeasuredBelts& belts, std::size_t first, std::size_t end) {
  MeasuredBelts part = belts;
  part.distances.clear();
  part.points.clear();
  const std::size_t count = end - first;
  const std::size_t taken = std::min(count, kMostOfAPart);
  for (std::size_t i = 0; i < taken; ++i) {
    const std::size_t at = taken > 1 ? i * (count - 1) / (taken - 1) : 0;
    part.points.push_back(belts.points[first + at]);
  }
  return part;
}

bool makes_a_frame(const MeasuredBelts& belts, std::size_t first, std::size_t end) {
  const auto fitted = belts::fit_anchors(evenly_of(belts, first, end));
  return fitted && fitted->is_sound && fitted->residual_sigma_mm < kOneFrameMm;
}

}  // namespace

std::optional<std::size_t> second_frame_begins(const MeasuredBelts& belts) {
  const std::size_t count = belts.points.size();
  if (count < 2 * kFewestBeltPoints || makes_a_frame(belts, 0, count)) return std::nullopt;
  std::size_t frame = kFewestBeltPoints;
  std::size_t none = count;
  if (!makes_a_frame(belts, 0, frame)) return std::nullopt;
  while (none - frame > 1) {
    const std::size_t middle = (frame + none) / 2;
    (makes_a_frame(belts, 0, middle) ? frame : none) = middle;
  }
  const bool both = count - frame >= kFewestBeltPoints && makes_a_frame(belts, frame, count);
  return both ? std::optional(frame) : std::nullopt;
}

}  // namespace chaintrue::grid
