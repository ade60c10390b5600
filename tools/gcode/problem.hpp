// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Why a G-code program is rejected: a stable name, the place, and a sentence for the user.
///
/// Readers of a program throw a Refusal; functions that run a whole program return the problem as a
/// Result.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <type_traits>
#include <utility>

namespace chaintrue::gcode {

enum class ProblemKind { bad_input, not_supported, outside };

enum class ProblemName {
#define CHAINTRUE_GCODE_PROBLEM(name, kind) name,
#include "tools/gcode/problems.def"
#undef CHAINTRUE_GCODE_PROBLEM
};

using enum ProblemName;

/// Place in the source file, counted from 1; column 0 is the line as a whole, line 0 the file.
struct Place {
  std::size_t line = 0;
  std::size_t column = 0;
};

struct Problem {
  ProblemName name = ProblemName::unreadable_file;
  Place place;
  std::string sentence;
  /// `line 4, column 12: the arc's end ... (bad_arc)`
  std::string message() const;
};

/// Stable identifier (`bad_arc`), used in documents, tests and JSON.
std::string_view name(ProblemName problem);
[[nodiscard]] ProblemKind kind(ProblemName problem);

struct Refusal final : std::exception {
  explicit Refusal(Problem found) : problem(std::move(found)) {}
  const char* what() const noexcept override { return problem.sentence.c_str(); }

  Problem problem;
};

/// \throws Refusal
[[noreturn]] void refuse(ProblemName problem, Place place, std::string sentence);

/// With the sentence's values.
template <class... Values>
requires(sizeof...(Values) > 0)
    [[noreturn]] void refuse(ProblemName problem, Place place,
                             fmt::format_string<Values...> sentence, Values&&... values) {
  refuse(problem, place, fmt::format(sentence, std::forward<Values>(values)...));
}

template <class T>
using Result = tl::expected<T, Problem>;

/// The result of the task, or the problem for which it is refused.
template <class Task>
[[nodiscard]] Result<std::invoke_result_t<Task>> attempt(Task&& task) {
  try {
    return task();
  } catch (const Refusal& refusal) {
    return tl::unexpected(refusal.problem);
  }
}

}  // namespace chaintrue::gcode
