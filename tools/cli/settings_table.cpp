// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/settings_table.hpp"

#include "grid/precondition.hpp"

namespace chaintrue::cli {
namespace {

using model::Setting;

struct SettingWords {
  Setting setting;
  std::string_view words;
  std::string_view unit;
  double factor;
};

constexpr SettingWords kSettingWords[] = {
    {Setting::motor_left_x_mm, "left motor, x", "mm", 1.0},
    {Setting::motor_left_y_mm, "left motor, y", "mm", 1.0},
    {Setting::motor_right_x_mm, "right motor, x", "mm", 1.0},
    {Setting::motor_right_y_mm, "right motor, y", "mm", 1.0},
    {Setting::chain_zero_left_mm, "left chain's zero", "mm", 1.0},
    {Setting::chain_zero_right_mm, "right chain's zero", "mm", 1.0},
    {Setting::sheet_x_mm, "sheet offset, right", "mm", 1.0},
    {Setting::sheet_y_mm, "sheet offset, up", "mm", 1.0},
    {Setting::sheet_rotation_rad, "sheet rotation, left", "mrad", 1000.0},
};

const SettingWords& words_of(Setting setting) {
  for (const SettingWords& words : kSettingWords) {
    if (words.setting == setting) return words;
  }
  throw grid::precondition("setting {} has no words", static_cast<int>(setting));
}

}  // namespace

std::string_view setting_in_words(Setting setting) { return words_of(setting).words; }
std::string_view unit_of(Setting setting) { return words_of(setting).unit; }
double in_unit(Setting setting, double value) { return words_of(setting).factor * value; }

Table settings_table(const std::vector<SettingRow>& settings) {
  Table table{.columns = {{.heading = "Settings", .width = 26},
                          {.heading = "in the file", .is_number = true, .width = 14},
                          {.heading = "+- in the file", .is_number = true, .detail = Detail::page},
                          {.heading = "calibrated", .is_number = true, .width = 12},
                          {.heading = "+- sigma", .is_number = true, .width = 11},
                          {.gap = 1},
                          {.gap = 2}},
              .is_headed = true,
              .head_width = 27};
  for (const SettingRow& row : settings) {
    const auto value = [&](double of) { return in_unit(row.setting, of); };
    std::vector<Cell> cells = {setting_in_words(row.setting),
                               value(row.stated),
                               row.stated_sigma ? Cell(value(*row.stated_sigma)) : Cell(),
                               value(row.calibrated),
                               value(row.sigma),
                               unit_of(row.setting)};
    if (row.is_off) cells.emplace_back("off: by more than the uncertainty in your file");
    table.rows.push_back({std::move(cells), row.is_off});
  }
  return table;
}

}  // namespace chaintrue::cli
