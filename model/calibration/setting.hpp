// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings as unknowns: their names, a machine's stated values and sigmas, and a machine with
/// changed values.
///
/// \code
///   for (Setting setting : kMachineSettings)
///     say(name(setting), stated_value(machine, setting), stated_sigma(machine, setting));
/// \endcode
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "model/reading_model.hpp"

namespace chaintrue::model {

/// Settings of the machine itself, in the order of results.
inline constexpr std::array kMachineSettings = {
    Setting::motor_left_x_mm,  Setting::motor_left_y_mm,    Setting::motor_right_x_mm,
    Setting::motor_right_y_mm, Setting::chain_zero_left_mm, Setting::chain_zero_right_mm,
};

/// Settings of a sheet that was placed by hand.
inline constexpr std::array kSheetSettings = {Setting::sheet_x_mm, Setting::sheet_y_mm,
                                              Setting::sheet_rotation_rad};

/// A setting of the sheet, not of the machine.
constexpr bool is_of_sheet(Setting setting) { return setting >= Setting::sheet_x_mm; }
/// Position among kSheetSettings.
constexpr int sheet_column(Setting setting) {
  return static_cast<int>(setting) - static_cast<int>(Setting::sheet_x_mm);
}

/// Identifier in files and messages (`motor_left_x_mm`, ...).
std::string_view name(Setting setting);
std::optional<Setting> setting_from_name(std::string_view word);

/// The stated value. \throws std::invalid_argument for a setting of the sheet: a machine has none.
double stated_value(const Machine& machine, Setting setting);
/// Sigma of the stated value. \throws as stated_value.
double stated_sigma(const Machine& machine, Setting setting);
/// The machine with that setting changed to `value` (in the setting's unit). \throws as
/// stated_value.
[[nodiscard]] Machine with_setting(Machine machine, Setting setting, double value);

}  // namespace chaintrue::model

/// Exported: this name is used throughout chaintrue.
namespace chaintrue {
using model::kMachineSettings;
}  // namespace chaintrue
