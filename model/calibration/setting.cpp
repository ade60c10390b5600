// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calibration/setting.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace chaintrue::model {
namespace {

struct SettingRow {
  Setting setting;
  std::string_view word;
  double& (*member)(Machine&);
  double Uncertainty::*sigma;
};

constexpr std::array kRows = {
    SettingRow{Setting::motor_left_x_mm, "motor_left_x_mm",
               [](Machine& m) -> double& { return m.motors.left.x_mm; },
               &Uncertainty::motor_position_mm},
    SettingRow{Setting::motor_left_y_mm, "motor_left_y_mm",
               [](Machine& m) -> double& { return m.motors.left.y_mm; },
               &Uncertainty::motor_position_mm},
    SettingRow{Setting::motor_right_x_mm, "motor_right_x_mm",
               [](Machine& m) -> double& { return m.motors.right.x_mm; },
               &Uncertainty::motor_position_mm},
    SettingRow{Setting::motor_right_y_mm, "motor_right_y_mm",
               [](Machine& m) -> double& { return m.motors.right.y_mm; },
               &Uncertainty::motor_position_mm},
    SettingRow{Setting::chain_zero_left_mm, "chain_zero_left_mm",
               [](Machine& m) -> double& { return m.chain_zero.left_mm; },
               &Uncertainty::chain_zero_mm},
    SettingRow{Setting::chain_zero_right_mm, "chain_zero_right_mm",
               [](Machine& m) -> double& { return m.chain_zero.right_mm; },
               &Uncertainty::chain_zero_mm},
    SettingRow{Setting::sheet_x_mm, "sheet_x_mm", nullptr, nullptr},
    SettingRow{Setting::sheet_y_mm, "sheet_y_mm", nullptr, nullptr},
    SettingRow{Setting::sheet_rotation_rad, "sheet_rotation_rad", nullptr, nullptr},
};

const SettingRow& row_of(Setting setting) {
  for (const SettingRow& row : kRows) {
    if (row.setting == setting) return row;
  }
  throw std::invalid_argument(
      fmt::format("no setting has the number {}", static_cast<int>(setting)));
}

const SettingRow& machine_row(Setting setting) {
  const SettingRow& row = row_of(setting);
  if (row.member == nullptr) {
    throw std::invalid_argument(
        fmt::format("{} is a setting of the sheet, not of the machine", row.word));
  }
  return row;
}

}  // namespace

std::string_view name(Setting setting) { return row_of(setting).word; }

std::optional<Setting> setting_from_name(std::string_view word) {
  for (const SettingRow& row : kRows) {
    if (row.word == word) return row.setting;
  }
  return std::nullopt;
}

double stated_value(const Machine& machine, Setting setting) {
  Machine copy = machine;
  return machine_row(setting).member(copy);
}

double stated_sigma(const Machine& machine, Setting setting) {
  return machine.uncertainty.*machine_row(setting).sigma;
}

Machine with_setting(Machine machine, Setting setting, double value) {
  machine_row(setting).member(machine) = value;
  return machine;
}

}  // namespace chaintrue::model
