// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What every verb's last line says, and how talk looks: in colours on a terminal, without any in a
/// pipe, or where NO_COLOR is set (no-color.org).
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::cli {

/// Standard error shows colours.
[[nodiscard]] bool shows_colours();
[[nodiscard]] std::string in_bold(std::string_view text);
[[nodiscard]] std::string in_red(std::string_view text);

/// The name under which the command was called, for the lines to paste: `build/chaintrue` as it was
/// typed, `chaintrue` where it was found on the path.
void set_called_as(std::string_view name);

/// `Next: chaintrue fit 'my marks.csv' -o map.json` on standard error, the words quoted where a
/// shell needs it. Nothing is said where one of the words is "-": a pipe goes on by itself.
void say_next(const std::vector<std::string>& words);

/// Messages under --quiet: kept back, and printed after all where the verb did not do what it was asked.
class QuietTalk {
 public:
  explicit QuietTalk(bool is_quiet);
  ~QuietTalk();
  QuietTalk(const QuietTalk&) = delete;
  QuietTalk& operator=(const QuietTalk&) = delete;
  /// From here on messages are printed again; what was kept back is printed first if `is_to_be_reported`.
  void end(bool is_to_be_reported);

 private:
  int heard_ = -1;  ///< where standard error went
  int kept_ = -1;
};

/// Standard output and standard error are one and the same: lines must then end before others begin.
void keep_lines_whole();

}  // namespace chaintrue::cli
