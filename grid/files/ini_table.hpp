// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An ini file as sections of keys with their lines. Private to grid/files. Keys and sections are
/// case-insensitive; lines that begin with ; or # are comments.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct IniEntry {
  std::string key;  ///< in lower case
  std::string text;
  std::string place;  ///< "line 12"
};

class IniTable {
 public:
  /// Reports lines that are neither a section, an entry, a comment nor blank, and keys that occur
  /// twice in a section.
  IniTable(std::string_view text, Problems& problems);
  /// For a program that has the same sections in another format: entries by section.
  explicit IniTable(std::map<std::string, std::vector<IniEntry>> sections);
  /// Null if no section has the key. `sections` are searched in order.
  [[nodiscard]] const IniEntry* find(const std::vector<std::string>& sections,
                                     const std::string& key) const;
  /// All keys of a section.
  [[nodiscard]] std::vector<std::string> keys(const std::string& section) const;
  [[nodiscard]] bool has_section(const std::string& section) const;

 private:
  std::map<std::string, std::vector<IniEntry>> sections_;
};

}  // namespace chaintrue::grid::files
