// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers without exponents.
#include "tools/gcode/word_text.hpp"

#include <array>
#include <charconv>

namespace chaintrue::gcode {

std::string with_value(std::string_view word, double value) {
  // The longest double in fixed notation has 1077 characters.
  std::array<char, 1100> digits{};
  const double plain = value == 0.0 ? 0.0 : value;
  const auto end =
      std::to_chars(digits.data(), digits.data() + digits.size(), plain, std::chars_format::fixed);
  std::string text(word);
  text.append(digits.data(), end.ptr);
  return text;
}

}  // namespace chaintrue::gcode
