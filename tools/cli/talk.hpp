// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Messages on standard error, the last line of every verb, and their style: coloured on a terminal, plain in a
/// pipe or if NO_COLOR is set (no-color.org).
#pragma once

#include <fmt/format.h>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/progress.hpp"
#include "tools/cli/arguments.hpp"

namespace chaintrue::grid {
enum class BeltsFitReason;
enum class CheckReason;
enum class FitReason;
enum class PlanReason;
namespace diagnosis {
enum class DiagnosisReason;
}
}  // namespace chaintrue::grid

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

void print_warnings(const std::vector<Warning>& warnings);
/// For the comments of a file that was made with these assumptions.
Words sentences_of(const std::vector<Warning>& warnings);

// Shows progress on a terminal after one second: elapsed time, the step and the number of steps
// and, if known, the share done and the time left. No output if standard error is not a terminal.
//
// \code
//   { const ProgressLine line("diagnose"); ... }            // main() does this for every verb
//   options.progress = shown_progress();                    // receives the steps of the work
//   progress_is(finished, total);                           // or the progress of a single step
//   end_progress();                                         // before printing anything
// \endcode
/// One at a time.
class ProgressLine {
 public:
  explicit ProgressLine(const std::string& verb);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
};

/// Shows the steps that it receives. Safe from any thread, and cheap.
grid::Progress shown_progress();
/// For the last step received, or the whole if none was.
void progress_is(double finished, double total);
/// Removes the line; nothing more is shown. No effect without a ProgressLine.
void end_progress();

// Thrown by a verb that cannot do its task with valid input: a sentence for the user, and
// the reason by a name that stays the same if sentences change.
//
// \code
//   const grid::Check check = value_of(grid::check_map(map, points), file.name);
// \endcode
/// The enumerator's own name: "no_machine".
std::string_view name_of(grid::BeltsFitReason reason);
std::string_view name_of(grid::CheckReason reason);
std::string_view name_of(grid::FitReason reason);
std::string_view name_of(grid::PlanReason reason);
std::string_view name_of(diagnosis::DiagnosisReason reason);

struct Failed : std::runtime_error {
  Failed(std::string file, std::string_view why, const std::string& sentence,
         int exit_code = kBadInput)
      : std::runtime_error(sentence), about(std::move(file)), reason(why), code(exit_code) {}
  /// \param failure a Failure of one of the reasons above
  template <class Failure>
  Failed(std::string file, const Failure& failure, int exit_code = kBadInput)
      : Failed(std::move(file), name_of(failure.reason), failure.sentence(), exit_code) {}

  /// The file, or the command, that the message begins with; empty: it was printed.
  std::string about;
  std::string reason;
  int code;
};

/// \throws Failed as above without a result
template <class T, class Failure>
T value_of(tl::expected<T, Failure> result, std::string about, int code = kBadInput) {
  if (!result) throw Failed(std::move(about), result.error(), code);
  return *std::move(result);
}

}  // namespace chaintrue::cli
