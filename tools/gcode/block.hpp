// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One line of a program as words, evaluated and checked as far as possible without the modal
/// state.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/codes.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {

/// The letters of the six axes.
inline constexpr std::string_view kAxisLetters = "xyzabc";

/// A word's letter as messages show it; any other character as it is.
[[nodiscard]] char upper(char letter);

/// `#5 = 1` or `#<name> = 1`; takes effect after the line is read.
struct Assignment {
  int index = 0;  ///< 0 for a named one
  std::string name;
  double value = 0.0;
  Place place;
};

/// For a line that is a whole program, and for a comment that has swallowed one.
inline constexpr const char* kLineEndsLost =
    "one line holds several moves: the file's line ends are lost; save it anew with its line ends";

/// Reused from line to line.
struct Block {
  std::array<const GCode*, kGGroups> g{};
  std::array<const MCode*, kMGroups> m{};
  std::vector<Assignment> assignments;
  bool deletable = false;  ///< began with a slash
  std::size_t line = 0;

  [[nodiscard]] bool has(char letter) const { return (present_ >> slot(letter) & 1U) != 0; }
  /// Only if has(letter).
  [[nodiscard]] double value(char letter) const { return values_[slot(letter)]; }
  [[nodiscard]] std::optional<double> find(char letter) const {
    return has(letter) ? std::optional(value(letter)) : std::nullopt;
  }
  [[nodiscard]] Place place(char letter) const { return {line, columns_[slot(letter)]}; }
  [[nodiscard]] Place start() const { return {line, 0}; }
  [[nodiscard]] const GCode* code(GGroup group) const { return g[static_cast<std::size_t>(group)]; }
  [[nodiscard]] const MCode* code(MGroup group) const { return m[static_cast<std::size_t>(group)]; }
  [[nodiscard]] bool is(GGroup group, int tenths) const {
    return code(group) != nullptr && code(group)->tenths == tenths;
  }
  [[nodiscard]] bool has_axes() const;
  /// Z and no other axis.
  [[nodiscard]] bool has_z_alone() const;
  [[nodiscard]] bool has_any_word() const { return present_ != 0; }

  void clear(std::size_t line_number);
  void put(char letter, double value, Place place);

 private:
  /// Letters a to z, then '@' and '^' (polar radius and angle).
  static std::size_t slot(char letter) {
    return letter == '@' ? 26U : letter == '^' ? 27U : static_cast<std::size_t>(letter - 'a');
  }

  std::uint32_t present_ = 0;
  std::array<double, 28> values_{};
  std::array<std::size_t, 28> columns_{};
};

/// Whether a text holds more moves than one line can, by its words G0 to G3 and X with a number.
[[nodiscard]] bool holds_moves(std::string_view text);

/// Reads the words after `reader` to the end of the line.
/// \param tools_have_no_diameter G41 and G42 then have no effect and are not rejected.
[[nodiscard]] Result<void> read_words(ValueReader reader,
                                      Block& block,
                                      bool tools_have_no_diameter = false);

}  // namespace chaintrue::gcode
