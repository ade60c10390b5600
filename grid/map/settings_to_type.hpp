// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The best settings that a Maslow's controller, left as it is, can hold: numbers to type in once, in
/// place of G-code compensated for every job. Found in the same way for a map and for a machine.
///
/// Least squares, by Gauss and Newton, of the tool's error over the area, (1) of
/// controller_error.hpp at places of the bed, with each setting held to the one in force by how well
/// such a number is usually known. They are never worse than the settings in force.
///
/// A firmware's formulas cannot say all that hangs: `typed` is what is left with them, `lacking` what
/// of it a firmware that knew more would mend. The tilt of the beam is a setting of the holey firmware
/// alone; where that of GroundControl 1.29 has the same number, it limits the z axis.
///
/// \code
///   const auto typed = settings_to_type(map);
///   if (typed) say(typed->settings.motor_spacing_mm, typed->as_it_is.rms_mm, typed->typed.rms_mm);
/// \endcode
#pragma once

#include <cstddef>
#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/compensation_map.hpp"
#include "model/failure.hpp"

namespace chaintrue::grid {

/// What acts on the machine and stands in no setting.
struct Lacking {
  /// An effect's id, "top_beam_tilt" or "chain_stretch".
  std::string what;
  /// By so much the error that is left grows because of it, as the root of a difference of squares.
  double costs_mm = 0.0;
};

struct SettingsToType {
  model::ControllerSettings settings;
  /// Error of the tool over the area, with the settings in force and with these.
  ErrorSummary as_it_is;
  ErrorSummary typed;
  /// Good points of the map, which all of it is fitted to; 0 of a machine.
  std::size_t points = 0;
  /// False where the settings in force are about as good as numbers can be; `settings` are then
  /// those, and `typed` is `as_it_is`.
  bool worth_typing = false;
  std::vector<Lacking> lacking;
};

enum class SettingsReason {
  no_machine,          ///< a map of splines through the lengths
  another_controller,  ///< whose settings are not a Maslow's
};
using SettingsFailure = Failure<SettingsReason>;

/// With the settings that the map's controller holds, or that `now` does.
[[nodiscard]] tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const CompensationMap& map);
[[nodiscard]] tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const CompensationMap& map, const model::Controller& now);
/// Over a convex hull of places on the bed. The machine is taken as it is: what is uncertain of it is in
/// neither error.
[[nodiscard]] tl::expected<SettingsToType, SettingsFailure> settings_to_type(
    const model::Machine& machine, const std::vector<model::BedPoint>& hull);

}  // namespace chaintrue::grid
