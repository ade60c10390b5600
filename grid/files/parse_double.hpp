// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// std::from_chars for double, also where the standard library has none (libc++ before 20).
#pragma once

#include <system_error>

namespace chaintrue::grid::files {

enum class NumberForm { general, fixed };

struct ParsedDouble {
  /// Behind the last character that belongs to the number; `first` where there is none.
  const char* end;
  /// invalid_argument: no number; result_out_of_range: `value` is left as it was.
  std::errc error;
};

/// As std::from_chars: no locale, no plus sign, no blanks in front; `fixed` stops before an
/// exponent. Correctly rounded.
ParsedDouble parse_double(const char* first,
                          const char* last,
                          double& value,
                          NumberForm form = NumberForm::general);

}  // namespace chaintrue::grid::files
