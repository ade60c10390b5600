// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings in force in a controller, under the names of its files, and the differences of two
/// controllers.
///
/// \code
///   const auto changes = changed_settings(settings_in_force(before), settings_in_force(now));
///   if (!changes.empty()) say(in_words(changes));   // "motorspacingx 2978.4 -> 2982.7791"
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "model/machine.hpp"

namespace chaintrue::grid::files {

struct NamedSetting {
  std::string name;
  std::string text;  ///< the value, in the digits that it has
};

/// For a Maslow GroundControl's names; for FluidNC's WallPlotter its anchors; for an ideal
/// controller its machine. `machine` is as it was stated, not as it was calibrated.
std::vector<NamedSetting> settings_in_force(const Machine& machine);

struct SettingChange {
  std::string name;
  std::string before;  ///< "not set" where it has none
  std::string now;
};

/// By more than the rounding that an export writes; a tilt or a tolerance that is not set is 0.
std::vector<SettingChange> changed_settings(const std::vector<NamedSetting>& before,
                                            const std::vector<NamedSetting>& now);

/// "motorspacingx 2978.4 -> 2982.7791, rotationradius 139.1 -> 138.2759"
std::string in_words(const std::vector<SettingChange>& changes);

/// Settings that define the chain per motor turn and the chain's path. Chain lengths measured
/// before such a change have a different meaning after it.
std::vector<SettingChange> of_the_chain(const std::vector<SettingChange>& changes);

}  // namespace chaintrue::grid::files
