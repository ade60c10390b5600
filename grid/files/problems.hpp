// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Collects the problems of one file, so that all are reported at once, and helpers for readable
/// messages. Shared by the JSON, CSV and ini readers.
///
/// \code
///   Problems problems("grid.csv");
///   problems.add("line 4, column 12", "abc", ProblemKind::not_a_number, "a number in mm");
///   problems.throw_if_any();
/// \endcode
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "grid/files/blanks.hpp"
#include "grid/files/input_error.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::files {

class Problems {
 public:
  explicit Problems(std::string file) : file_(std::move(file)) {}

  /// `value` is shortened to 60 characters and made printable here.
  void add(std::string place, std::string_view value, ProblemKind kind, std::string expected);
  template <class... Args>
  requires(sizeof...(Args) > 0) void add(std::string place, std::string_view value,
                                         ProblemKind kind, fmt::format_string<Args...> expected,
                                         Args&&... args) {
    add(std::move(place), value, kind, fmt::format(expected, std::forward<Args>(args)...));
  }
  /// A value that no machine has.
  void add(std::string place, const MachineProblem& problem) {
    add(std::move(place), problem.value, ProblemKind::impossible, problem.expected);
  }
  /// Each at its parameter: "the machine's /bed/width_mm".
  void add_all(const std::string& whose, const std::vector<MachineProblem>& found) {
    for (const MachineProblem& problem : found) add(whose + problem.parameter, problem);
  }
  /// A recognised mistake: `sentence` describes it and what to do.
  void explain(std::string place, ProblemKind kind, std::string sentence);
  void warn(std::string place, std::string sentence, ProblemKind kind = ProblemKind::unexpected);
  template <class... Args>
  requires(sizeof...(Args) > 0) void warn(std::string place, fmt::format_string<Args...> sentence,
                                          Args&&... args) {
    warn(std::move(place), fmt::format(sentence, std::forward<Args>(args)...));
  }
  /// Adds those of another file that this one names.
  void add_all(const std::vector<InputProblem>& found);
  void add_warnings(const std::vector<Warning>& warnings);
  /// True if something was reported at this JSON pointer or below it.
  bool at_or_below(std::string_view pointer) const;
  bool any() const { return !list_.empty(); }
  const std::string& file() const { return file_; }
  const std::vector<InputProblem>& list() const { return list_; }
  const std::vector<Warning>& warnings() const { return warnings_; }
  /// \throws InputError with everything collected; beyond kMostOfAKind with the same expectation,
  /// and beyond kMostProblems in all, the rest is counted, not listed.
  void throw_if_any() const;

  static constexpr std::size_t kMostOfAKind = 5;
  static constexpr std::size_t kMostProblems = 100;

 private:
  std::string file_;
  std::vector<InputProblem> list_;
  std::vector<Warning> warnings_;
};

/// At most 60 characters, on one line, without control characters; cut between UTF-8 characters.
std::string shortened(std::string_view text);
/// `line 4`
std::string line_place(std::size_t line);
/// `line 4, column 12`, both from 1; the column counts bytes.
std::string line_and_column(std::size_t line, std::size_t column);
std::string line_and_column_of(std::string_view text, std::size_t offset);
/// The candidate with the smallest edit distance, or the word with the unit that it lacks; empty if
/// none is near.
std::string nearest(std::string_view word, const std::vector<std::string>& candidates);
/// `a, b, c`
std::string joined(const std::vector<std::string>& words);

}  // namespace chaintrue::grid::files
