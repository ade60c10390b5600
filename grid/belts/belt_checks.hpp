// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Gross errors that four lengths per place reveal before anchors are estimated: exchanged belts,
/// and places that fit no anchors.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

using BeltPair = std::pair<Belt, Belt>;

/// Likely exchanges: one pair, followed by its mirror image; then two pairs at once, which give a
/// valid frame turned over.
const std::array<std::vector<BeltPair>, 9>& belt_swaps();
/// "tl and tr swapped and bl and br as well".
std::string words_of(const std::vector<BeltPair>& swapped);

/// Belts whose lengths change places in the whole file.
struct SwappedBelts {
  /// One pair, or two: both left belts with both right ones.
  std::vector<BeltPair> belts;
  /// If only lengths are known, two pairs give mirror images of one frame.
  std::optional<BeltPair> or_else;
  double as_stated_mm = 0.0;  ///< residual of the lengths
  double swapped_mm = 0.0;
};
/// Swapped belts are considered if the stated lengths fit no frame, or one far from the stated
/// anchors or commands.
std::optional<SwappedBelts> suspected_swap(const MeasuredBelts& belts);

/// The frame fitted to the lengths without a tape; empty if they fit none.
std::optional<AnchorFit> frame_of_lengths(const MeasuredBelts& belts);

/// A point whose lengths do not meet.
struct NowherePoint {
  std::size_t point = 0;
  double residual_mm = 0.0;  ///< residual of the worst belt at the best place
};
/// With the anchors fitted to the other points.
std::vector<NowherePoint> points_nowhere(const MeasuredBelts& belts, const AnchorFit& frame);

/// A reading that the other three belts contradict, and the writing error that would explain it.
struct BeltQuestion {
  std::size_t point = 0;
  Belt belt{};
  std::string sentence;
};
std::vector<BeltQuestion> suspected_readings(const MeasuredBelts& belts, const AnchorFit& frame);

/// A taped distance that no scale of the belts explains: off by more than 1.5 % and five sigmas
/// from the prediction by lengths alone or, if the other tapes agree with it, by more than an
/// eighth.
struct DistanceQuestion {
  std::size_t distance = 0;
  double by_belts_mm = 0.0;
  std::string question;
};
std::vector<DistanceQuestion> suspected_distances(const MeasuredBelts& belts,
                                                  const AnchorFit& frame);

struct OtherUnit {
  const char* word;
  double factor;  ///< makes millimetres
  double found;   ///< the median length, unchanged
};
/// If no frame is as small as these lengths.
std::optional<OtherUnit> suspected_unit(const MeasuredBelts& belts);

}  // namespace chaintrue::grid
