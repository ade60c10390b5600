// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/ini_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/files/blanks.hpp"

namespace chaintrue::grid::files {
namespace {

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return small;
}

/// With more unrecognised lines than this the file is not an ini file.
constexpr std::size_t kMostStrangeLines = 5;
/// Ground Control's own files have about a hundred.
constexpr std::size_t kMostSettings = 5000;

}  // namespace

IniTable::IniTable(std::string_view text, Problems& problems) {
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark)
    text.remove_prefix(kByteOrderMark.size());
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
    problems.add("", "an empty file", "an ini file with [sections]", ProblemKind::empty_file);
  }
  std::vector<IniEntry>* section = nullptr;
  std::size_t strange = 0;
  std::size_t settings = 0;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty() || line.front() == ';' || line.front() == '#') continue;
    const std::string place = fmt::format("line {}", number);
    if (line.front() == '[' && line.back() == ']') {
      section = &sections_[in_small_letters(trimmed(line.substr(1, line.size() - 2)))];
      continue;
    }
    const std::size_t sign = line.find_first_of("=:");
    if (sign == 0 || sign == std::string_view::npos || section == nullptr) {
      problems.add(place, line, "[a section] or key = value in a section, as in an ini file",
                   ProblemKind::bad_syntax);
      if (++strange == kMostStrangeLines) return;
      continue;
    }
    if (++settings > kMostSettings) {
      problems.add(place, "more settings", fmt::format("at most {} lines of settings", kMostSettings));
      return;
    }
    IniEntry entry{in_small_letters(trimmed(line.substr(0, sign))),
                   std::string(trimmed(line.substr(sign + 1))),
                   place};
    const auto same =
        std::find_if(section->begin(), section->end(), [&entry](const IniEntry& other) {
          return other.key == entry.key;
        });
    if (same != section->end()) {
      problems.add(place, line, fmt::format("this key once; it stands at {} already", same->place),
                   ProblemKind::repeated_key);
    } else {
      section->push_back(std::move(entry));
    }
  }
}

IniTable::IniTable(std::map<std::string, std::vector<IniEntry>> sections) {
  for (auto& [name, entries] : sections) {
    for (IniEntry& entry : entries) entry.key = in_small_letters(entry.key);
    sections_[in_small_letters(name)] = std::move(entries);
  }
}

const IniEntry* IniTable::find(const std::vector<std::string>& sections,
                               const std::string& key) const {
  for (const std::string& name : sections) {
    const auto section = sections_.find(in_small_letters(name));
    if (section == sections_.end()) continue;
    for (const IniEntry& entry : section->second) {
      if (entry.key == key) return &entry;
    }
  }
  return nullptr;
}

std::vector<std::string> IniTable::keys(const std::string& section) const {
  std::vector<std::string> keys;
  const auto found = sections_.find(in_small_letters(section));
  if (found == sections_.end()) return keys;
  for (const IniEntry& entry : found->second) keys.push_back(entry.key);
  return keys;
}

bool IniTable::has_section(const std::string& section) const {
  return sections_.count(in_small_letters(section)) > 0;
}

}  // namespace chaintrue::grid::files
