// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The best settings for a Maslow's unchanged controller: numbers to type in once instead of
/// compensating the G-code of every job. Works the same way for a map and for a machine.
///
/// Least squares, by Gauss and Newton, of the tool's error over the area, (1) of
/// controller_error.hpp at places of the bed, with the settings in force as prior, to their usual
/// accuracy. They are never worse than the settings in force. A firmware's formulas do not model
/// everything: `typed` is the remaining error, `lacking` the part that a better firmware would
/// correct. The tilt of the beam is a setting of the holey firmware alone; where that of
/// GroundControl 1.29 has the same number, it limits the z axis.
///
/// \code
///   const auto typed = settings_to_type(map);
///   if (typed) say(typed->settings.motor_spacing_mm, typed->as_it_is.rms_mm, typed->typed.rms_mm);
/// \endcode
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "interp/eigen.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

/// The first part of (1) of controller_error.hpp with some values, which are settings of the
/// controller; empty if it cannot go to a place with them.
using ErrorsAt = std::function<std::optional<VectorXd>(const VectorXd& values)>;
struct ErrorsLine {
  VectorXd errors;
  MatrixXd by_value;  ///< by central differences of a hundredth
};
/// Empty where `errors_at` has no value.
std::optional<ErrorsLine> linearised(const ErrorsAt& errors_at, const VectorXd& values);

/// An influence on the machine that no setting describes.
struct Lacking {
  /// An effect's id, "top_beam_tilt" or "chain_stretch".
  std::string what;
  /// Its contribution to the remaining error, as the root of a difference of squares.
  double costs_mm = 0.0;
};

struct SettingsToType {
  model::ControllerSettings settings;
  /// Error of the tool over the area, with the settings in force and with these.
  ErrorSummary as_it_is;
  ErrorSummary typed;
  /// Good points of the map, to which all of this is fitted; 0 for a machine.
  std::size_t points = 0;
  /// False if no settings are clearly better than those in force; `settings` are then the ones in
  /// force, and `typed` is `as_it_is`.
  bool worth_typing = false;
  std::vector<Lacking> lacking;
};

enum class SettingsReason {
  no_machine,          ///< a map of splines through the lengths
  another_controller,  ///< the settings are not a Maslow's
};
using SettingsFailure = Failure<SettingsReason>;

/// With the settings of the map's controller, or of `now`.
[[nodiscard]] tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const CompensationMap& map, const std::optional<model::Controller>& now = std::nullopt);
/// Over a convex hull of places on the bed. The machine is taken as exact: neither error includes
/// its uncertainty.
[[nodiscard]] tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const Machine& machine, const std::vector<BedPoint>& hull);

}  // namespace chaintrue::grid
