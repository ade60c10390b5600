// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compares the lengths of four belts with those predicted by the anchors in force at the commanded
/// places. It needs one place and no fit.
///
/// The controller moves by its upper two belts, so these agree with its anchors to a few
/// millimetres whatever the true frame; the lower two depend on the true frame.
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
  PerBelt<double> median_mm;  ///< of read less expected
  double upper_mm = 0.0;      ///< median of the amounts of the upper two
  /// Belts that, changed for one another, agree with the commands at least four times as well.
  std::optional<std::vector<BeltPair>> swapped;
};
/// Empty if no anchors are in force, or no place has a command that they reach.
std::optional<AgainstCommands> against_commands(const MeasuredBelts& belts);

/// The stated anchors are not those of the measured frame. Either a stated coordinate is many
/// sigmas from the fitted one, or the upper two belts, by which the machine moves, do not read what
/// the stated anchors predict at the commanded place.
struct OtherFrame {
  std::string coordinate;  ///< "tr x", the one farthest off
  double stated_mm = 0.0;
  double fitted_mm = 0.0;
  /// Median absolute difference of the upper belts from the commands; 0: no commands.
  double upper_mm = 0.0;
};
/// `frame` is the fit without a tape. Empty if the stated anchors may be right or none are stated.
std::optional<OtherFrame> suspected_other_frame(const MeasuredBelts& belts, const AnchorFit& frame);

}  // namespace chaintrue::grid
