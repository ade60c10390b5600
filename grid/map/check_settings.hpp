// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A check whose points were commanded with settings other than the map's: can settings that
/// were, or were not, typed in explain the result instead of a change of the machine?
///
/// The points' chain lengths are what the controller has paid out for their commands, so each set of
/// settings predicts its own readings. All are compared with the same map; with n readings and
///
///   chi2 = sum_i (r_i / sigma_i)^2                                                          (1)
///
/// the settings have changed if they reduce chi2 by at least kFarBetter and leave a valid map. Of m
/// different numbers all or some may have changed. A part has to gain 2 log(2^m - 2) more, because
/// all parts together have the prior of the full change.
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
  bool all = false;          ///< all numbers are the other ones
  double as_it_is_mm = 0.0;  ///< rms of the residuals, settings of the map
  double with_these_mm = 0.0;
};

/// `found` is the check of `map` against `measured`. Empty if its own settings fit, if no others
/// explain the points, or if no point gives a command.
std::optional<ChangedSettings> changed_settings(const CompensationMap& map,
                                                const Measured& measured,
                                                const model::ControllerSettings& others,
                                                const Check& found);

}  // namespace chaintrue::grid
