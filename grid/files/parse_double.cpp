// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/parse_double.hpp"

#include <charconv>

#ifndef __cpp_lib_to_chars
#include <fast_float/fast_float.h>

#include <algorithm>
#include <cmath>
#endif

namespace chaintrue::grid::files {

#ifdef __cpp_lib_to_chars

ParsedDouble parse_double(const char* first, const char* last, double& value, NumberForm form) {
  const auto chars_format =
      form == NumberForm::fixed ? std::chars_format::fixed : std::chars_format::general;
  const auto [end, error] = std::from_chars(first, last, value, chars_format);
  return {end, error};
}

#else

namespace {

/// fast_float returns infinity or zero if the standard requires out of range: infinity for a
/// text of digits, zero for a text whose mantissa is not zero.
bool is_out_of_range(const char* first, const char* end, double value) {
  if (std::isinf(value)) return std::any_of(first, end, is_digit);
  if (value != 0.0) return false;
  const char* const mantissa_end =
      std::find_if(first, end, [](char c) { return c == 'e' || c == 'E'; });
  return std::any_of(first, mantissa_end, [](char c) { return c >= '1' && c <= '9'; });
}

}  // namespace

ParsedDouble parse_double(const char* first, const char* last, double& value, NumberForm form) {
  const auto chars_format = form == NumberForm::fixed ? fast_float::chars_format::fixed
                                                      : fast_float::chars_format::general;
  double parsed = 0.0;
  const auto [end, error] = fast_float::from_chars(first, last, parsed, chars_format);
  if (error != std::errc{}) return {end, error};
  if (is_out_of_range(first, end, parsed)) return {end, std::errc::result_out_of_range};
  value = parsed;
  return {end, std::errc{}};
}

#endif

}  // namespace chaintrue::grid::files
