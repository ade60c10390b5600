// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/groundcontrol_settings.hpp"
#include "grid/files/json_text.hpp"

#include <fmt/format.h>

namespace chaintrue::grid::files {
namespace {

/// Most versions write numbers as texts, some as numbers.
std::string text_of(const Json& value) {
  if (value.is_string()) return value.get<std::string>();
  return value.is_null() ? std::string() : value.dump();
}

}  // namespace

bool is_webcontrol(const std::string& text, const std::string& file) {
  const Json json = parse_json(text, file);
  return json.is_object() && json.contains("Maslow Settings") && json.contains("Advanced Settings");
}

ReadMachine parse_webcontrol(const std::string& text, const std::string& file) {
  Problems problems(file);
  const Json json = parse_json(text, problems);
  problems.throw_if_any();
  SettingTexts texts;
  for (const auto& [section, settings] : json.items()) {
    if (!settings.is_array()) continue;
    for (const auto i : each_index(settings)) {
      const Json& setting = settings[i];
      if (!setting.is_object() || !setting.contains("key") || !setting.contains("value")) continue;
      texts[in_small_letters(section + "/" + text_of(setting.at("key")))] = {
          text_of(setting.at("value")), fmt::format("/{}/{}/value", section, i)};
    }
  }
  return machine_of_settings(std::move(texts), Tolerances::are_pitch, problems);
}

}  // namespace chaintrue::grid::files
