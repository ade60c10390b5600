// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross errors that four lengths a place show before anchors are estimated: belts under one another's
/// names, and places that no anchors make sense of.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

using BeltPair = std::pair<model::Belt, model::Belt>;

/// What a hand exchanges: one pair, its mirror image next to it; then two pairs at once, which leave a
/// frame a frame and turn it over.
[[nodiscard]] const std::array<std::vector<BeltPair>, 9>& belt_swaps();
/// "tl and tr swapped and bl and br as well".
[[nodiscard]] std::string words_of(const std::vector<BeltPair>& swapped);

/// Belts whose lengths change places in the whole file.
struct SwappedBelts {
  /// One pair, or two: both left belts with both right ones.
  std::vector<BeltPair> belts;
  /// Where nothing but lengths is known, two pairs make mirror images of one frame.
  std::optional<BeltPair> or_else;
  double as_stated_mm = 0.0;  ///< what the lengths contradict each other by
  double swapped_mm = 0.0;
};
/// A frame of swapped belts is looked for where the lengths as stated make none, or one that is far
/// from the anchors or the commands that the file states.
[[nodiscard]] std::optional<SwappedBelts> suspected_swap(const MeasuredBelts& belts);

/// The frame that the lengths make without any tape; empty where they make none.
[[nodiscard]] std::optional<belts::AnchorFit> frame_of_lengths(const MeasuredBelts& belts);

/// A point whose lengths end nowhere together.
struct NowherePoint {
  std::size_t point = 0;
  double residual_mm = 0.0;  ///< what the best place leaves of the worst belt
};
/// With the anchors that the other points make.
[[nodiscard]] std::vector<NowherePoint> points_nowhere(const MeasuredBelts& belts,
                                                       const belts::AnchorFit& frame);

/// A reading that the other three belts contradict, and the writing error that would explain it.
struct BeltQuestion {
  std::size_t point = 0;
  model::Belt belt{};
  std::string sentence;
};
[[nodiscard]] std::vector<BeltQuestion> suspected_readings(const MeasuredBelts& belts,
                                                           const belts::AnchorFit& frame);

/// A taped distance that no scale of belts explains: off by more than 1.5 % and five sigmas of what the
/// lengths alone make of it, or, where the other tapes agree with it, by more than an eighth.
struct DistanceQuestion {
  std::size_t distance = 0;
  double by_belts_mm = 0.0;
  std::string question;
};
[[nodiscard]] std::vector<DistanceQuestion> suspected_distances(const MeasuredBelts& belts,
                                                                const belts::AnchorFit& frame);

struct OtherUnit {
  const char* word;
  double factor;  ///< makes millimetres
  double found;   ///< the median length, as it stands
};
/// Where no frame is as small as these lengths are.
[[nodiscard]] std::optional<OtherUnit> suspected_unit(const MeasuredBelts& belts);

}  // namespace chaintrue::grid
