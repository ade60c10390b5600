// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings of another program by their paths, read one by one, and the unused ones. Shared by
/// every importer. Private to grid/files.
///
/// \code
///   SettingReader settings(yaml_texts(text, problems), problems);
///   const double x = settings.need("kinematics/WallPlotter/left_anchor_x", kAnchor);
///   settings.warn_of_others("says where the pen hangs");
/// \endcode
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/blanks.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/problems.hpp"

namespace chaintrue::grid::files {

struct SettingText {
  std::string text;
  std::string place;  ///< "line 4"
};
/// By path, "folder/key".
using SettingTexts = std::map<std::string, SettingText>;

class SettingReader {
 public:
  /// A key is looked for in `folders`, in order; without any it is the whole path.
  SettingReader(SettingTexts texts, Problems& problems, std::vector<std::string> folders = {});

  /// Null if it is missing.
  const SettingText* look(const std::string& key);
  /// Empty if it is missing or reported.
  std::optional<double> find(const std::string& key, const Range& range);
  /// 0 if it is missing, which is reported, or wrong.
  double need(const std::string& key, const Range& range);
  /// One of `words`; another is reported.
  std::optional<std::string> find_word(const std::string& key,
                                       const std::vector<std::string>& words);
  /// For a text with no other settings: the others are reported.
  void refuse_others();
  /// Lists the unused settings: "ignored, because none of it `says_what`: ...". For an unused
  /// folder only the folder is listed.
  void warn_of_others(std::string_view says_what);

  bool empty() const { return texts_.empty(); }

 private:
  SettingTexts texts_;
  Problems& problems_;
  std::vector<std::string> folders_;
  std::set<std::string> asked_;  ///< keys
  std::set<std::string> read_;   ///< paths
};

/// Calls `visit(line, place)` for each line.
template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
  for (std::size_t number = 1; !text.empty(); ++number)
    visit(take_until(text, '\n'), line_place(number));
}

/// The part of YAML that FluidNC's settings use: keys by their indentation, and the value after the
/// colon. "kinematics/WallPlotter/left_anchor_x". Reports keys that occur twice at one place.
SettingTexts yaml_texts(const std::string& text, Problems& problems);

/// Settings, one a line, "key=12", "key: 12 mm"; `before` is the text before a key;
/// other lines are ignored.
SettingTexts line_texts(const std::string& text, char separator, std::string_view before = "");

/// An ini file, "section/key" in lower case. Lines that begin with ; or # are comments. Reports lines
/// that are neither a section, an entry, a comment nor blank, and keys that occur twice in a section.
SettingTexts ini_texts(std::string_view text, Problems& problems);

/// The anchors of FluidNC's WallPlotter, in its own coordinates; fluidnc_file.cpp.
PerSide<model::MotorPosition> fluidnc_anchors(SettingReader& settings);

}  // namespace chaintrue::grid::files
