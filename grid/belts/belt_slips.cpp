// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/belts/belt_slips.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "grid/belts/settled_frame.hpp"
#include "model/belts/belt_kinematics.hpp"

namespace chaintrue::grid {

using model::Belt;
using model::kBelts;

namespace {

/// Frames of real machines contradict themselves by 3 mm at most, with the arms left out; one of
/// swapped belts by tens and hundreds.
constexpr double kSoundMm = 15.0;
/// A swap must be better by this much to be suspected.
constexpr double kBetter = 4.0;
/// Anchors that are known to a decimetre or two; a mirror image is off by a side of the frame.
constexpr double kFarMm = 400.0;
/// Far above what settling leaves, and far below any reading's noise.
constexpr double kRoundingMm = 1e-6;
/// As many points tell a swap as well as all.
constexpr std::size_t kMostLookedAt = 16;

constexpr std::array<BeltPair, 6> kPairs = {BeltPair{Belt::tl, Belt::tr},
                                            BeltPair{Belt::bl, Belt::br},
                                            BeltPair{Belt::tl, Belt::bl},
                                            BeltPair{Belt::tr, Belt::br},
                                            BeltPair{Belt::tl, Belt::br},
                                            BeltPair{Belt::tr, Belt::bl}};

MeasuredBelts looked_at(const MeasuredBelts& belts) {
  MeasuredBelts few = belts;
  few.distances.clear();
  few.points.clear();
  const std::size_t count = std::min(belts.points.size(), kMostLookedAt);
  for (std::size_t i = 0; i < count; ++i) {
    few.points.push_back(belts.points[i * belts.points.size() / count]);
  }
  return few;
}

MeasuredBelts swapped(MeasuredBelts belts, BeltPair pair) {
  for (BeltPoint& point : belts.points) {
    std::swap(point.lengths_mm[pair.first], point.lengths_mm[pair.second]);
  }
  return belts;
}

struct Frame {
  double spread_mm = std::numeric_limits<double>::infinity();
  /// From what the file states of anchors, or of commands; 0 where it states neither.
  double far_mm = 0.0;
};

double far_from_commands(const MeasuredBelts& belts, const std::vector<model::FramePoint>& places) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> off;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto& commanded = belts.points[k].commanded;
    if (!commanded) continue;
    off.emplace_back(places[k].x_mm - commanded->x_mm, places[k].y_mm - commanded->y_mm);
    mean += off.back();
  }
  if (off.empty()) return 0.0;
  mean /= static_cast<double>(off.size());
  double square = 0.0;
  for (const Eigen::Vector2d& one : off) square += (one - mean).squaredNorm();
  return std::sqrt(square / static_cast<double>(off.size()));
}

/// A share of how far the commands themselves reach: mirrored ones are off by as much as that.
bool are_commands_far(const MeasuredBelts& belts, double far_mm) {
  std::vector<model::FramePoint> origin(belts.points.size());
  const double reach_mm = far_from_commands(belts, origin);
  return reach_mm > 0.0 && far_mm > 0.5 * reach_mm;
}

Frame frame_of(const MeasuredBelts& belts) {
  Frame frame;
  const auto settled = belts::settle(belts);
  if (!settled || !settled->is_sound) return frame;
  frame.spread_mm = settled->spread_mm;
  if (belts.machine.anchors_known) {
    frame.far_mm =
        (settled->state.anchors - belts::anchors_of(belts.machine)).cwiseAbs().maxCoeff();
  } else {
    frame.far_mm = far_from_commands(belts, settled->state.places);
  }
  return frame;
}

bool is_far(const MeasuredBelts& belts, const Frame& frame) {
  return belts.machine.anchors_known ? frame.far_mm > kFarMm
                                     : are_commands_far(belts, frame.far_mm);
}

}  // namespace

std::optional<SwappedBelts> suspected_swap(const MeasuredBelts& belts) {
  const MeasuredBelts few = looked_at(belts);
  if (few.points.size() < kFewestBeltPoints) return std::nullopt;
  const Frame as_stated = frame_of(few);
  const bool is_frame = as_stated.spread_mm < kSoundMm;
  if (is_frame && !is_far(few, as_stated)) return std::nullopt;
  std::array<Frame, kPairs.size()> frames;
  for (std::size_t i = 0; i < kPairs.size(); ++i) frames[i] = frame_of(swapped(few, kPairs[i]));
  const auto is_better = [&](const Frame& frame) {
    if (frame.spread_mm > kSoundMm || is_far(few, frame)) return false;
    return is_frame || kBetter * frame.spread_mm < as_stated.spread_mm;
  };
  // Of pairs that are mirror images of each other the first: only rounding tells them apart.
  const auto is_nearer = [](const Frame& a, const Frame& b) {
    if (std::abs(a.far_mm - b.far_mm) > kRoundingMm) return a.far_mm < b.far_mm;
    return a.spread_mm < b.spread_mm - kRoundingMm;
  };
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (is_better(frames[i]) && (!best || is_nearer(frames[i], frames[*best]))) best = i;
  }
  if (!best) return std::nullopt;
  SwappedBelts result{kPairs[*best], std::nullopt, as_stated.spread_mm, frames[*best].spread_mm};
  const std::size_t mirrored = *best % 2 == 0 ? *best + 1 : *best - 1;
  if (frames[*best].far_mm == 0.0 && is_better(frames[mirrored])) result.or_else = kPairs[mirrored];
  return result;
}

std::vector<NowherePoint> points_nowhere(const MeasuredBelts& belts) {
  // A lost digit or another frame; what a machine or a hand is off by is for the fit to name.
  constexpr double kNowhereMm = 100.0;
  MeasuredBelts untaped = belts;
  untaped.distances.clear();
  std::vector<NowherePoint> result;
  const auto frame = belts::settle_robustly(untaped);
  if (!frame || !frame->is_sound) return result;
  const model::BeltMachine machine = belts::with_anchors(belts.machine, frame->state.anchors);
  for (std::size_t k = 0; k < belts.points.size(); ++k) {
    int aside = 0;
    for (const Belt belt : kBelts) aside += frame->counting[k][belt] ? 0 : 1;
    if (aside < 2) continue;
    const auto place = belts::nearest_place(
        machine, belts.points[k], model::PerBelt<bool>{true, true, true, true});
    double off_mm = 0.0;
    for (const Belt belt : kBelts) {
      const auto reading = model::reading_at(machine, belt, place);
      if (reading)
        off_mm = std::max(off_mm, std::abs(belts.points[k].lengths_mm[belt] - reading->length_mm));
    }
    if (off_mm > kNowhereMm) result.push_back({k, off_mm});
  }
  return result;
}

}  // namespace chaintrue::grid
