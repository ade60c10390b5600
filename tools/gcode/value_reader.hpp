// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers, parameters and expressions of RS274/NGC, evaluated as they are read.
///
/// A value is a number, `#` parameter, `[` expression `]`, a function (`sin[30]`, `atan[1]/[2]`,
/// degrees), or any of these after a sign. Operators, tightest first: `**` · `* / mod` · `+ -` ·
/// `eq ne gt ge lt le` · `and or xor`; all group from the left. `eq` and `ne` compare to 0.0001, as
/// LinuxCNC does. There are no exponents: E is a word.
#pragma once

#include <numbers>
#include <string>
#include <string_view>

#include "tools/gcode/clean_line.hpp"
#include "tools/gcode/parameters.hpp"

namespace chaintrue::gcode {

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

class ValueReader {
 public:
  /// Keeps references to both.
  ValueReader(const CleanLine& line, const Parameters& parameters, std::size_t at = 0)
      : line_(line), parameters_(parameters), at_(at) {}

  [[nodiscard]] bool done() const { return at_ >= line_.text.size(); }
  /// The current character, or zero at the end.
  [[nodiscard]] char peek() const { return done() ? '\0' : line_.text[at_]; }
  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] Place place() const { return line_.place(at_); }
  void skip(std::size_t count) { at_ += count; }
  /// Reads `text` if it is next.
  bool accept(std::string_view text);

  [[nodiscard]] Result<double> real();
  /// A real value within 0.0001 of an integer.
  [[nodiscard]] Result<long> integer();
  /// `[` ... `]`
  [[nodiscard]] Result<double> bracketed();
  /// `<name>`, without its brackets.
  [[nodiscard]] Result<std::string> angle_name();

 private:
  struct Nesting;

  [[nodiscard]] Result<double> number();
  [[nodiscard]] Result<double> parameter();
  [[nodiscard]] Result<double> function();
  [[nodiscard]] Result<double> exists();
  [[nodiscard]] Result<double> operand_chain(int lowest_precedence);

  const CleanLine& line_;
  const Parameters& parameters_;
  std::size_t at_;
  int depth_ = 0;
};

}  // namespace chaintrue::gcode
