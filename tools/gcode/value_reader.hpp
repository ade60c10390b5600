// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Numbers, parameters and expressions of RS274/NGC, evaluated as they are read.
///
/// A value is a number, `#` parameter, `[` expression `]`, a function (`sin[30]`, `atan[1]/[2]`,
/// degrees), or any of these after a sign. Operators, tightest first: `**` · `* / mod` · `+ -` ·
/// `eq ne gt ge lt le` · `and or xor`; all group from the left. `eq` and `ne` compare to 0.0001, as
/// LinuxCNC does. There are no exponents: E is a word.
///
/// The parameters of a program: numbered ones (#1 .. #5602), named ones (#<name> local to a
/// subroutine, #<_name> global), and those that give the interpreter's state.
///
/// Lengths in #5161-#5390 are in mm for every unit of the program, as in LinuxCNC on a metric
/// machine.
///
/// with_value() writes the value of a word.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

/// Indices with a meaning. Coordinate system p (1 .. 9) has its X origin at kFirstSystem + 20 (p -
/// 1), then Y, Z, A, B, C, U, V, W, and its rotation in degrees at index X + 9.
namespace parameter {
inline constexpr int kProbe = 5061;
inline constexpr int kHome = 5161;
inline constexpr int kSecondHome = 5181;
inline constexpr int kOffsetOn = 5210;
inline constexpr int kOffset = 5211;
inline constexpr int kSystem = 5220;
inline constexpr int kFirstSystem = 5221;
inline constexpr int kTool = 5400;  ///< in the spindle
inline constexpr int kPosition = 5420;
inline constexpr int kCount = 5603;
}  // namespace parameter

class Parameters {
 public:
  /// Returns the value of a predefined name, which follows the interpreter's state.
  using State = std::function<std::optional<double>(std::string_view)>;

  explicit Parameters(State state);

  /// \param index 1 .. kCount - 1.
  double get(int index) const;
  void set(int index, double value);
  bool writable(int index) const;
  /// The stored value, in mm if it is a length; without the interpreter's state.
  double stored(int index) const { return values_[static_cast<std::size_t>(index)]; }

  std::optional<double> get(std::string_view name) const;
  /// A name of the interpreter's state keeps its value.
  void set(std::string_view name, double value);

  /// Enters a subroutine: its #1 .. #30 are the arguments, and its local names start empty.
  void enter(const std::vector<double>& arguments);
  void leave();

 private:
  using Names = std::map<std::string, double, std::less<>>;
  static constexpr std::size_t kArguments = 30;
  struct Frame {
    std::array<double, kArguments> saved{};
    Names names;
  };

  std::vector<double> values_;
  Names global_;
  std::vector<Frame> frames_;
  State state_;
};

inline constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;

class ValueReader {
 public:
  /// Keeps references to both.
  ValueReader(const CleanLine& line, const Parameters& parameters, std::size_t at = 0)
      : line_(line), parameters_(parameters), at_(at) {}

  bool done() const { return at_ >= line_.text.size(); }
  /// The current character, or zero at the end.
  char peek() const { return line_.text[at_]; }
  std::size_t at() const { return at_; }
  Place place() const { return line_.place(at_); }
  void skip(std::size_t count) { at_ += count; }
  /// Reads `text` if it is next.
  bool accept(std::string_view text);

  double real();
  /// A real value within 0.0001 of an integer.
  long integer();
  /// `[` ... `]`
  double bracketed();
  /// `<name>`, without its brackets.
  std::string angle_name();

 private:
  double operand();
  double number();
  double parameter();
  double function();
  double exists();
  double operand_chain(int lowest_precedence);

  const CleanLine& line_;
  const Parameters& parameters_;
  std::size_t at_;  // at most the end of the text, where a string has a zero
  int depth_ = 0;
};

/// The word and the shortest decimal fraction that reads back as the same number: no exponent,
/// which no controller reads, and no minus zero.
/// \code
///   with_value("G4 P", 1e-5)   // G4 P0.00001
/// \endcode
[[nodiscard]] std::string with_value(std::string_view word, double value);

}  // namespace chaintrue::gcode
