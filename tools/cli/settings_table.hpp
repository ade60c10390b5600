// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The machine's settings in words, stated and calibrated.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "model/calibration/setting.hpp"
#include "tools/cli/names.hpp"
#include "tools/report/document.hpp"

namespace chaintrue::cli {

/// "left motor, x" for motor_left_x_mm, and its unit.
[[nodiscard]] std::string_view setting_in_words(model::Setting setting);
[[nodiscard]] std::string_view unit_of(model::Setting setting);
/// A setting's value in that unit: rotations in mrad.
[[nodiscard]] double in_unit(model::Setting setting, double value);

/// In the setting's own unit.
struct SettingRow {
  model::Setting setting;
  double stated = 0.0;
  std::optional<double> stated_sigma;
  double calibrated = 0.0;
  double sigma = 0.0;
  /// Farther from the stated value than its uncertainty allows.
  bool is_off = false;
};
[[nodiscard]] Table settings_table(const std::vector<SettingRow>& settings);

}  // namespace chaintrue::cli
