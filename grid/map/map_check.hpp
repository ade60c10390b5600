// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compares a few new points with a compensation map: whether anything has changed since it was
/// measured, what, and whether re-zeroing corrects it. The possible changes are those of two chains
/// (chain_changes.hpp), with the evidence of check_evidence.hpp. K there is the noise of the new
/// readings, the map's uncertainty, and the stated placement of a new sheet.
///
/// \code
///   const auto check = check_map(map, grid);          // or holes
///   if (check && check->verdict == CheckVerdict::valid) carry_on();
/// \endcode
#pragma once

#include <optional>
#include <tl/expected.hpp>

#include "grid/map/check.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"
#include "grid/progress.hpp"
#include "model/controllers/controller.hpp"

namespace chaintrue::grid {

/// Any mix of files. Effects of the paper and of the visit of the files' machine are removed from
/// the readings first (corrected_data.hpp), as it is for a map.
[[nodiscard]] tl::expected<Check, CheckFailure> check_map(const CompensationMap& map,
                                                          const Measured& measured,
                                                          const Progress& progress = {});

// A check whose points were commanded with settings other than the map's: can settings that
// were, or were not, typed in explain the result instead of a change of the machine?
//
// The points' chain lengths are what the controller has paid out for their commands, so each set of
// settings predicts its own readings. All are compared with the same map; with n readings and
//
//   chi2 = sum_i (r_i / sigma_i)^2                                                          (1)
//
// the settings have changed if they reduce chi2 by at least kFarBetter and leave a valid map. Of m
// different numbers all or some may have changed. A part has to gain 2 log(2^m - 2) more, because
// all parts together have the prior of the full change.

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
