// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// An ini file as sections of keys with their lines. Private to grid/files. Keys and sections are
/// blind to case; lines that begin with ; or # are comments.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct IniEntry {
  std::string key;  ///< in small letters
  std::string text;
  std::string place;  ///< "line 12"
};

class IniTable {
 public:
  /// Reports lines that are neither a section, an entry, a comment nor blank, and keys that stand
  /// twice in a section.
  IniTable(std::string_view text, Problems& problems);
  /// Of a program that keeps the same sections in another form: entries by section.
  explicit IniTable(std::map<std::string, std::vector<IniEntry>> sections);
  /// Nothing where no section has the key. `sections` are looked through in turn.
  [[nodiscard]] const IniEntry* find(const std::vector<std::string>& sections,
                                     const std::string& key) const;
  /// All keys of a section.
  [[nodiscard]] std::vector<std::string> keys(const std::string& section) const;
  [[nodiscard]] bool has_section(const std::string& section) const;

 private:
  std::map<std::string, std::vector<IniEntry>> sections_;
};

}  // namespace chaintrue::grid::files
