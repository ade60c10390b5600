// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/controller_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/records.hpp"
#include "model/calibration/setting.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kOfTheChain[] = {"chainpitch", "gearteeth", "chainoversprocket"};
/// Settings that a firmware reads as 0 if they are not set.
constexpr std::string_view kZeroUnlessSet[] = {"topbeamtilt", "leftchaintolerance",
                                               "rightchaintolerance"};

const NamedSetting* find(const std::vector<NamedSetting>& settings, const std::string& name) {
  return find_where(settings, having(&NamedSetting::name, name));
}

/// The text, or the words for a missing value.
std::string value_of(const NamedSetting* setting, const std::string& name) {
  if (setting != nullptr) return setting->text;
  return contains(kZeroUnlessSet, name) ? "0" : "";
}

bool are_equal(const std::string& a, const std::string& b) {
  if (a == b) return true;
  const auto x = number_of(a);
  const auto y = number_of(b);
  if (!x || !y) return false;
  // An export writes four decimals, and four digits of smaller values.
  constexpr double kHalfAUnit = 0.5001e-4;
  constexpr double kSmall = 1e-3;
  constexpr double kShare = 1e-3;
  const double largest = std::max(std::abs(*x), std::abs(*y));
  return std::abs(*x - *y) <= (largest < kSmall ? kShare * largest : kHalfAUnit);
}

}  // namespace

std::vector<NamedSetting> settings_in_force(const Machine& machine) {
  Json json = Json::object();
  if (machine.controller.kind == ControllerKind::fluidnc_wallplotter) {
    const auto& [left, right] = machine.motors;
    json = {{"left_anchor_x", left.x_mm},
            {"left_anchor_y", left.y_mm},
            {"right_anchor_x", right.x_mm},
            {"right_anchor_y", right.y_mm}};
  } else if (machine.controller.kind == ControllerKind::ideal) {
    for (const Setting setting : kMachineSettings)
      json[std::string(name(setting))] = stated_value(machine, setting);
  } else {
    json = controller_settings_record().write(machine.controller.settings);
  }
  std::vector<NamedSetting> settings;
  for (const auto& [name, value] : json.items()) {
    settings.push_back({name, value.is_string() ? value.get<std::string>()
                                                : fmt::format("{}", value.get<double>())});
  }
  return settings;
}

std::vector<SettingChange> changed_settings(const std::vector<NamedSetting>& before,
                                            const std::vector<NamedSetting>& now) {
  std::vector<SettingChange> changes;
  const auto compare = [&](const std::string& name) {
    const std::string old_value = value_of(find(before, name), name);
    const std::string new_value = value_of(find(now, name), name);
    if (are_equal(old_value, new_value)) return;
    const auto shown = [](const std::string& value) { return value.empty() ? "not set" : value; };
    changes.push_back({name, shown(old_value), shown(new_value)});
  };
  for (const NamedSetting& setting : before) compare(setting.name);
  for (const NamedSetting& setting : now) {
    if (find(before, setting.name) == nullptr) compare(setting.name);
  }
  return changes;
}

std::string in_words(const std::vector<SettingChange>& changes) {
  return joined(mapped(changes, [](const SettingChange& change) {
    return fmt::format("{} {} -> {}", change.name, change.before, change.now);
  }));
}

std::vector<SettingChange> of_the_chain(const std::vector<SettingChange>& changes) {
  std::vector<SettingChange> result = changes;
  std::erase_if(result, [](const auto& change) { return !contains(kOfTheChain, change.name); });
  return result;
}

}  // namespace chaintrue::grid::files
