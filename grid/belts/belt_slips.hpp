// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Slips that four lengths a place show before any anchors are believed: belts under one another's
/// names, and places that no anchors make sense of.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "grid/belts/measured_belts.hpp"

namespace chaintrue::grid {

using BeltPair = std::pair<model::Belt, model::Belt>;

/// Two belts whose lengths change places in the whole file.
struct SwappedBelts {
  BeltPair belts;
  /// Where nothing but lengths is known, two pairs make mirror images of one frame.
  std::optional<BeltPair> or_else;
  double as_stated_mm = 0.0;  ///< what the lengths contradict each other by
  double swapped_mm = 0.0;
};
/// A frame of swapped belts is looked for where the lengths as stated make none, or one that is far
/// from the anchors or the commands that the file states.
[[nodiscard]] std::optional<SwappedBelts> suspected_swap(const MeasuredBelts& belts);

/// A point whose lengths end nowhere together.
struct NowherePoint {
  std::size_t point = 0;
  double off_mm = 0.0;  ///< what the best place leaves of the worst belt
};
/// With the anchors that the other points make.
[[nodiscard]] std::vector<NowherePoint> points_nowhere(const MeasuredBelts& belts);

}  // namespace chaintrue::grid
