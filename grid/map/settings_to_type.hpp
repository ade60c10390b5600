// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings with which a Maslow's controller, left as it is, comes nearest to a map: numbers to
/// type in once, in place of G-code compensated for every job.
///
/// Least squares, by Gauss and Newton, of the tool's error over the measured part of the bed,
/// (1) of controller_error.hpp at places of the bed, with each setting held to the one in force by
/// how well such a number is usually known.
///
/// A firmware's formulas cannot say all that a map can: `typed` is what is left with them.
///
/// \code
///   const auto typed = settings_to_type(map);
///   if (typed) say(typed->settings.motor_spacing_mm, typed->as_it_is.rms_mm, typed->typed.rms_mm);
/// \endcode
#pragma once

#include <cstddef>
#include <string>
#include <tl/expected.hpp>

#include "grid/map/compensation_map.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

struct SettingsToType {
  model::ControllerSettings settings;
  /// Error of the tool over the measured part, with the settings in force and with these, mm.
  ErrorSummary as_it_is;
  ErrorSummary typed;
  /// Good points of the map, which all of it is fitted to.
  std::size_t points = 0;
  /// False where the settings in force are about as good as numbers can be; `settings` are then
  /// those, and `typed` is `as_it_is`.
  bool worth_typing = false;
};

enum class SettingsReason {
  no_machine,         ///< a map of splines through the lengths
  another_controller  ///< whose settings are not a Maslow's, or a sled on brackets
};
using SettingsFailure = Failure<SettingsReason>;

[[nodiscard]] tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const CompensationMap& map);

}  // namespace chaintrue::grid
