// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether the anchors that are stated are those of the frame that was measured.
///
/// Two signs: a stated coordinate lies far from the one that the lengths make, by many of its sigmas;
/// or the upper two belts, by which the machine moves, do not read what the stated anchors have where it
/// was sent.
#pragma once

#include <optional>
#include <string>

#include "grid/belts/anchor_fit.hpp"

namespace chaintrue::grid {

struct OtherFrame {
  std::string coordinate;  ///< "tr x", the one farthest off
  double stated_mm = 0.0;
  double fitted_mm = 0.0;
  /// What the upper belts read less the commands, median of the amounts; 0: no commands.
  double upper_mm = 0.0;
};
/// `frame` is what the lengths make without a tape. Empty where the stated anchors may be right, or none
/// are.
[[nodiscard]] std::optional<OtherFrame> suspected_other_frame(const MeasuredBelts& belts,
                                                              const belts::AnchorFit& frame);

}  // namespace chaintrue::grid
