// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// std::from_chars for double, also for standard libraries without it (libc++ before 20).
#pragma once

#include <system_error>

namespace chaintrue::grid::files {

enum class NumberForm { general, fixed };

struct ParsedDouble {
  /// After the last character that belongs to the number; `first` if there is no number.
  const char* end;
  /// invalid_argument: no number; result_out_of_range: `value` is unchanged.
  std::errc error;
};

constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// As std::from_chars: no locale, no plus sign, no blanks in front; `fixed` stops before an
/// exponent. Correctly rounded.
ParsedDouble parse_double(const char* first, const char* last, double& value,
                          NumberForm form = NumberForm::general);

}  // namespace chaintrue::grid::files
