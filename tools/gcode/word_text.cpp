// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers without exponents.
#include "tools/gcode/word_text.hpp"

#include <array>
#include <charconv>

#ifndef __cpp_lib_to_chars
#include <fmt/format.h>

#include "grid/files/parse_double.hpp"
#endif

namespace chaintrue::gcode {
namespace {

#ifdef __cpp_lib_to_chars

void append_fixed(std::string& text, double value) {
  // The longest double in fixed notation has 1077 characters.
  std::array<char, 1100> digits{};
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), value, std::chars_format::fixed);
  text.append(digits.data(), end.ptr);
}

#else

/// The fewest decimals that read back as the value: the digits of std::to_chars, which libc++
/// supports only from version 14 on.
void append_fixed(std::string& text, double value) {
  constexpr int kMostDecimals = 1074;  // of the smallest double
  for (int decimals = 0; decimals <= kMostDecimals; ++decimals) {
    const std::string digits = fmt::format("{:.{}f}", value, decimals);
    double read = 0.0;
    grid::files::parse_double(digits.data(), digits.data() + digits.size(), read);
    if (read != value && decimals < kMostDecimals) continue;
    text += digits;
    return;
  }
}

#endif

}  // namespace

std::string with_value(std::string_view word, double value) {
  std::string text(word);
  append_fixed(text, value == 0.0 ? 0.0 : value);
  return text;
}

}  // namespace chaintrue::gcode
