// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Lengths of four belts against those that the anchors in force would give where the machine was sent.
/// One place is enough: it needs no fit of anchors.
///
/// A controller moves by its upper two belts, so that these read what its anchors say to a few
/// millimetres whatever the true frame is; the lower two read what the true frame makes of it.
///
/// \code
///   const auto found = against_commands(belts);
///   if (found && found->swapped) say("exchanged", *found->swapped);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/belts/anchor_fit.hpp"
#include "grid/belts/belt_checks.hpp"

namespace chaintrue::grid {

struct AgainstCommands {
  std::size_t places = 0;
  model::PerBelt<double> median_mm;  ///< of read less expected
  double typical_mm = 0.0;           ///< median of the amounts, over all four belts
  double upper_mm = 0.0;             ///< the same of the upper two
  /// Belts that, changed for one another, agree with the commands at least four times as well.
  std::optional<std::vector<BeltPair>> swapped;
};
/// Empty where no anchors are in force, or no place has a command that they reach.
[[nodiscard]] std::optional<AgainstCommands> against_commands(const MeasuredBelts& belts);

/// The anchors that are stated are not those of the frame that was measured. Two signs: a stated coordinate
/// lies far from the one that the lengths make, by many of its sigmas; or the upper two belts, by which the
/// machine moves, do not read what the stated anchors have where it was sent.
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
