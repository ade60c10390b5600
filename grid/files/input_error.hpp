// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bad input, reported completely: every problem of a file at once, each with file, place, value
/// found and what was expected.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "grid/problem_kind.hpp"

namespace chaintrue::grid::files {

struct InputProblem {
  std::string file;
  /// JSON pointer ("/points/3/x_mm"), or "line 4, column 12", or empty for the file as a whole.
  std::string place;
  /// As found, shortened to 60 characters; empty where something is missing.
  std::string value;
  /// What was expected.
  std::string expected;
  /// If the likely mistake is recognised: what it is and what to do, in the owner's words. It then
  /// replaces value and expected in the message.
  std::string sentence = {};
  ProblemKind kind = ProblemKind::unexpected;
  /// `grid.json: /points/3/x_mm: found "abc", expected a number in mm`
  std::string message() const;
  /// The name of its kind; "missing" if nothing was found.
  std::string_view name() const;
};

/// A problem that does not stop the reading, in a sentence; the caller prints it. Its kind is
/// unexpected unless it is that of a recognised mistake.
using Warning = InputProblem;

/// Thrown once, with all problems; the command turns it into exit code 3.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<InputProblem> problems);
  [[nodiscard]] const std::vector<InputProblem>& problems() const { return problems_; }

 private:
  std::vector<InputProblem> problems_;
};

/// \throws InputError with one problem.
[[noreturn]] void refuse(std::string file, std::string place, std::string found,
                         std::string expected, ProblemKind kind = ProblemKind::unexpected);
/// As above, of the file as a whole.
[[noreturn]] void refuse(std::string file, std::string found, std::string expected,
                         ProblemKind kind = ProblemKind::unexpected);

/// The system's message for an error number, in English in every locale.
std::string system_words(int error_number);

}  // namespace chaintrue::grid::files
