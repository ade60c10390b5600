// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The last line of every verb, and the style of messages: coloured on a terminal, plain in a
/// pipe or if NO_COLOR is set (no-color.org).
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace chaintrue::cli {

/// Whether standard error shows colours.
[[nodiscard]] bool shows_colours();
[[nodiscard]] std::string in_bold(std::string_view text);
[[nodiscard]] std::string in_red(std::string_view text);

/// The name under which the command was called, for the lines to paste: `build/chaintrue` as typed,
/// `chaintrue` if it was found on the path.
void set_called_as(std::string_view name);

/// `Next: chaintrue fit 'my marks.csv' -o map.json` on standard error, the words quoted for a shell
/// if necessary. Prints nothing if one of the words is "-": the pipeline continues.
void say_next(const std::vector<std::string>& words);

/// Messages under --quiet: stored, and printed if the verb fails.
class QuietTalk {
 public:
  explicit QuietTalk(bool is_quiet);
  ~QuietTalk();
  QuietTalk(const QuietTalk&) = delete;
  QuietTalk& operator=(const QuietTalk&) = delete;
  /// Messages are printed again; stored ones are printed first if `is_to_be_reported`.
  void end(bool is_to_be_reported);

 private:
  int heard_ = -1;  ///< where standard error went
  int kept_ = -1;
};

/// Whether standard output and standard error are the same: lines must then end before others
/// begin.
void write_whole_lines();

}  // namespace chaintrue::cli
