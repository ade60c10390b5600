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
#include <vector>

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

}  // namespace chaintrue::grid
