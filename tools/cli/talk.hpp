// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Messages on standard error, the last line of every verb, and their style: coloured on a terminal, plain in a
/// pipe or if NO_COLOR is set (no-color.org).
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/input_error.hpp"
#include "tools/cli/arguments.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// Whether standard error shows colours.
bool shows_colours();
std::string in_bold(std::string_view text);
std::string in_red(std::string_view text);

/// The name under which the command was called, for the lines to paste: `build/chaintrue` as typed,
/// `chaintrue` if it was found on the path.
void set_called_as(std::string_view name);

/// A line on standard error.
template <class... Args>
void say(::fmt::format_string<Args...> text, Args&&... args) {
  fmt::print(stderr, "{}\n", fmt::format(text, std::forward<Args>(args)...));
}

/// Text that has its own line breaks.
void say_lines(std::string_view lines);

/// Adds an option with its value to a command's words; nothing for an empty value.
void add_option_words(Words& words, std::string option, std::string value);
/// With each of the values.
void add_option_words(Words& words, const std::string& option, const Words& values);

/// `Next: chaintrue fit 'my marks.csv' -o map.json` on standard error, the words quoted for a shell
/// if necessary. Prints nothing if one of the words is "-": the pipeline continues.
void say_next(const Words& words);

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

// Prints a reader's assumptions and warnings on standard error.

/// `message (name)` if the environment has CHAINTRUE_PROBLEM_NAMES, for tests and other programs:
/// names are stable when sentences change. Otherwise only the message.
[[nodiscard]] std::string with_name(std::string message, std::string_view name);

void print_warnings(const std::vector<files::Warning>& warnings);
/// For the comments of a file that was made with these assumptions.
std::vector<std::string> sentences_of(const std::vector<files::Warning>& warnings);

}  // namespace chaintrue::cli
