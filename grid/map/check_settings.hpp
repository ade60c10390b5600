// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A check whose points were commanded with other settings than the map is for: do numbers that were typed
/// in, or were not, and no change of the machine, explain what it found?
///
/// The points' chain lengths are what the controller has paid out for their commands, so each set of
/// settings makes readings of its own. All are held against the same map; with n readings and
///
///   chi2 = sum_i (r_i / sigma_i)^2                                                          (1)
///
/// the settings have changed where they take at least kFarBetter off chi2 and leave a valid map. Of m numbers
/// that differ all, or any part of them, may be the other ones. A part has to gain 2 log(2^m - 2) more: there
/// are so many of them, and together they are as likely beforehand as all numbers are.
#pragma once

#include <optional>

#include "grid/map/map_check.hpp"
#include "model/controllers/controller.hpp"

namespace chaintrue::grid {

/// Twice the logarithm of a likelihood ratio of ten thousand.
inline constexpr double kFarBetter = 18.4;

struct ChangedSettings {
  Check check;  ///< of the map for `in_force`, against the points
  model::ControllerSettings in_force;
  bool all = false;  ///< all numbers are the other ones
  double as_it_is_mm = 0.0;  ///< rms of the residuals, settings of the map
  double with_these_mm = 0.0;
};

/// `found` is what the check of `map` against `measured` says. Nothing where its own settings serve,
/// where none of the others explain the points, or where no point gives a command.
[[nodiscard]] std::optional<ChangedSettings> changed_settings(const CompensationMap& map,
                                                              const Measured& measured,
                                                              const model::ControllerSettings& others,
                                                              const Check& found);

}  // namespace chaintrue::grid
