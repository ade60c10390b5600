// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Why a G-code program is rejected: a stable name, the place, and a sentence for the user.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <utility>

namespace chaintrue::gcode {

enum class ProblemKind { bad_input, not_supported, outside };

enum class ProblemName {
#define CHAINTRUE_GCODE_PROBLEM(name, kind) name,
#include "tools/gcode/problems.def"
#undef CHAINTRUE_GCODE_PROBLEM
};

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
  [[nodiscard]] std::string message() const;
};

/// Stable identifier (`bad_arc`), used in documents, tests and JSON.
[[nodiscard]] std::string_view name(ProblemName problem);
[[nodiscard]] ProblemKind kind(ProblemName problem);

template <class T>
using Result = tl::expected<T, Problem>;

[[nodiscard]] inline tl::unexpected<Problem> refuse(ProblemName problem,
                                                    Place place,
                                                    std::string sentence) {
  return tl::unexpected<Problem>(Problem{problem, place, std::move(sentence)});
}

}  // namespace chaintrue::gcode

/// Returns the problem of a Result from the calling function, if it has one.
#define CHAINTRUE_GCODE_TRY(result)                                                            \
  do {                                                                                         \
    auto&& chaintrue_result = (result);                                                        \
    if (!chaintrue_result) {                                                                   \
      return tl::unexpected<::chaintrue::gcode::Problem>(std::move(chaintrue_result).error()); \
    }                                                                                          \
  } while (false)
