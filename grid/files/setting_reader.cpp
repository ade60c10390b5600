// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/setting_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/pattern.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::string_view kParts = "/.";

/// A text with this many unrecognised lines is no ini file.
constexpr std::size_t kMostStrangeLines = 5;
/// Ground Control's own files have about a hundred.
constexpr std::size_t kMostSettings = 5000;

/// Longer lists of ignored settings end in a count.
constexpr std::size_t kMostNamed = 60;

/// \param places of the keys so far \return false, and reports it, if the key is already there
bool is_first(std::map<std::string, std::string>& places, const std::string& key,
              const std::string& place, std::string_view line, Problems& problems) {
  const auto [same, is_new] = places.emplace(key, place);
  if (!is_new) {
    problems.add(place, line, ProblemKind::repeated_key, "this key only once; it is already at {}",
                 same->second);
  }
  return is_new;
}

void refuse_more_settings(const std::string& place, Problems& problems) {
  problems.add(place, "more settings", ProblemKind::too_many, "at most {} lines of settings",
               kMostSettings);
}

}  // namespace

SettingReader::SettingReader(SettingTexts texts, Problems& problems, Words folders)
    : texts_(std::move(texts)), problems_(problems), folders_(std::move(folders)) {
  if (texts_.size() > kMostSettings) refuse_more_settings("", problems);
}

const SettingText* SettingReader::look(const std::string& key) {
  asked_.insert(key);
  const auto at = [&](const std::string& path) -> const SettingText* {
    const auto found = texts_.find(path);
    if (found == texts_.end()) return nullptr;
    read_.insert(path);
    return &found->second;
  };
  if (folders_.empty()) return at(key);
  for (const std::string& folder : folders_) {
    if (const SettingText* text = at(in_small_letters(folder) + "/" + key)) return text;
  }
  return nullptr;
}

std::optional<double> SettingReader::find(const std::string& key, const Range& range) {
  const SettingText* setting = look(key);
  if (setting == nullptr) return std::nullopt;
  return checked_number(setting->text, setting->place, key, range, problems_);
}

double SettingReader::need(const std::string& key, const Range& range) {
  if (look(key) == nullptr) {
    problems_.add(key, "", ProblemKind::missing,
                  folders_.empty() ? range.expected()
                                   : fmt::format("{}, in [{}]", range.expected(),
                                                 fmt::join(folders_, "] or [")));
  }
  return find(key, range).value_or(0.0);
}

std::optional<std::string> SettingReader::find_word(const std::string& key, const Words& words) {
  const SettingText* setting = look(key);
  if (setting == nullptr) return std::nullopt;
  if (contains(words, setting->text)) return setting->text;
  problems_.add(setting->place, setting->text.empty() ? "nothing" : setting->text,
                ProblemKind::unknown_word, "{} ({})", fmt::join(words, " or "), key);
  return std::nullopt;
}

void SettingReader::refuse_others() {
  for (const auto& [path, setting] : texts_) {
    if (!read_.contains(path))
      problems_.add(setting.place, path, ProblemKind::unknown_word, "one of {}",
                    fmt::join(asked_, ", "));
  }
}

void SettingReader::warn_of_others(std::string_view says_what) {
  const auto is_folder_of_input = [&](const std::string& folder) {
    const auto first = read_.lower_bound(folder);
    return first != read_.end() && first->starts_with(folder);
  };
  Words names;
  for (const auto& [path, setting] : texts_) {
    if (read_.contains(path)) continue;
    std::size_t part = path.find_first_of(kParts);
    while (part != npos && is_folder_of_input(path.substr(0, part + 1)))
      part = path.find_first_of(kParts, part + 1);
    const bool is_leaf = part == npos;
    std::string name = is_leaf ? (folders_.empty() ? path : path.substr(path.rfind('/') + 1))
                               : fmt::format("all of {}", path.substr(0, part));
    if (names.empty() || names.back() != name) names.push_back(std::move(name));
  }
  if (names.empty()) return;
  const std::size_t more = names.size() - std::min(names.size(), kMostNamed);
  names.resize(names.size() - more);
  problems_.warn("", "ignored, because none of it {}: {}{}", says_what, fmt::join(names, ", "),
                 more == 0 ? "" : fmt::format(" and {} more", more));
}

SettingTexts yaml_texts(const std::string& text, Problems& problems) {
  struct Level {
    std::size_t indent;
    std::string path;
  };
  std::vector<Level> levels;
  SettingTexts texts;
  std::map<std::string, std::string> places;
  each_line(text, [&](std::string_view line, const std::string& place) {
    line = line.substr(0, line.find('#'));
    const std::size_t indent = line.find_first_not_of(' ');
    const std::size_t colon = line.find(':');
    if (indent == npos || colon == npos || texts.size() > kMostSettings) return;
    while (!levels.empty() && levels.back().indent >= indent) levels.pop_back();
    const std::string key(line.substr(indent, colon - indent));
    const std::string path = levels.empty() ? key : levels.back().path + "/" + key;
    levels.push_back({indent, path});
    const bool is_of_a_list = has(path, "/-") || path.starts_with("-");
    if (!is_of_a_list && !is_first(places, path, place, trimmed(line), problems)) return;
    const std::string value(trimmed(line.substr(colon + 1)));
    if (!value.empty()) texts[path] = {value, place};
  });
  return texts;
}

SettingTexts line_texts(const std::string& text, char separator, std::string_view before) {
  SettingTexts texts;
  each_line(text, [&](std::string_view line, const std::string& place) {
    const std::size_t begin = line.find(before);
    if (begin == npos || line.starts_with("#") || texts.size() > kMostSettings) return;
    std::string_view value = line.substr(begin + before.size());
    if (!has(value, separator)) return;
    const std::string key(trimmed(take_until(value, separator)));
    const auto part = match(trimmed(value), "(.*?)[ \t]*(?:mm|kg|1/N|/N)?");
    texts[key] = {std::string(part.empty() ? trimmed(value) : part[1]), place};
  });
  return texts;
}

SettingTexts ini_texts(std::string_view text, Problems& problems) {
  text = without_byte_order_mark(text);
  SettingTexts texts;
  if (text.find_first_not_of(" \t\r\n") == npos) {
    problems.add("", "an empty file", ProblemKind::empty_file, "an ini file with [sections]");
  }
  std::map<std::string, std::string> places;
  std::string section;
  std::size_t strange = 0;
  std::size_t settings = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = trimmed(take_until(text, '\n'));
    if (line.empty() || line.front() == ';' || line.front() == '#') continue;
    const std::string place = line_place(number);
    if (line.front() == '[' && line.back() == ']') {
      section = in_small_letters(trimmed(line.substr(1, line.size() - 2))) + "/";
      continue;
    }
    const std::size_t sign = line.find_first_of("=:");
    if (sign == 0 || sign == npos || section.empty()) {
      problems.add(place, line, ProblemKind::bad_syntax,
                   "[a section] or key = value in a section, as in an ini file");
      if (++strange == kMostStrangeLines) break;
      continue;
    }
    if (settings++ == kMostSettings) {
      refuse_more_settings(place, problems);
      break;
    }
    const std::string key = section + in_small_letters(trimmed(line.substr(0, sign)));
    if (is_first(places, key, place, line, problems))
      texts[key] = {std::string(trimmed(line.substr(sign + 1))), place};
  }
  return texts;
}

}  // namespace chaintrue::grid::files
