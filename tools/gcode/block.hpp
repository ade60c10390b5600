// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// One line of a program as words, evaluated and checked as far as possible without the modal
/// state; and the tables of G and M codes: name, modal group, words, reason for a refusal.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/gcode/events.hpp"
#include "tools/gcode/value_reader.hpp"

namespace chaintrue::gcode {

/// Codes of one group exclude each other within a block.
enum class Group : std::uint8_t {
  // of G
  once,
  motion,
  plane,
  distance,
  arc_distance,
  feed_mode,
  units,
  cutter,
  tool_length,
  retract,
  system,
  path_control,
  spindle_mode,
  diameter,
  scaling,
  // of M
  stop,
  spindle,
  tool,
  coolant,
  override,
  output,
  state,
  flow,
};
inline constexpr std::size_t kGroups = 23;

/// The G codes by name: g::rapid is G0, g::machine_frame is G53.
namespace g {
struct Name {
  int tenths;
  Group group;
  constexpr operator int() const { return tenths; }
  constexpr operator Code() const { return {'G', tenths}; }
};
#define CHAINTRUE_GCODE_G(name, tenths, group, words, refusal) \
  inline constexpr Name name{tenths, Group::group};
#include "tools/gcode/g_codes.def"
#undef CHAINTRUE_GCODE_G
}  // namespace g

/// M3 is m(3).
constexpr Code m(int number) { return {'M', 10 * number}; }

struct KnownCode : Code {
  Group group;
  std::string_view words;  ///< as in g_codes.def
  const char* refusal;     ///< why it is not supported; null if it is

  constexpr bool uses(char word) const { return words.find(word) != std::string_view::npos; }
};

/// G73 and G81 to G89; a motion is given in tenths.
constexpr bool is_cycle(int motion) {
  return motion == g::peck_break || (motion >= g::drill && motion <= g::bore_dwell);
}
constexpr bool is_arc(int motion) {
  return motion == g::arc_clockwise || motion == g::arc_counterclockwise;
}
constexpr bool is_probe(int motion) {
  return motion >= g::probe && motion <= g::probe_away_quietly;
}

/// The indices of a plane's axes, in the order that makes first x second = normal.
struct PlaneAxes {
  std::size_t first = 0;
  std::size_t second = 1;
  std::size_t normal = 2;
};

constexpr PlaneAxes plane_axes(int plane) {
  if (plane == g::plane_zx) return {2, 0, 1};
  if (plane == g::plane_yz) return {1, 2, 0};
  return {0, 1, 2};
}

std::span<const KnownCode> known_codes();
/// Null if the code is unknown.
const KnownCode* find(Code code);

/// For coordinate system 1 (G54) to 9 (G59.3).
constexpr int system_code(int system) {
  return system <= 6 ? g::system_1 + 10 * (system - 1) : g::system_7 + system - 7;
}

/// The letters of the six axes.
inline constexpr std::string_view kAxisLetters = "xyzabc";

/// `#5 = 1` or `#<name> = 1`; takes effect after the line is read.
struct Assignment {
  int index = 0;  ///< 0 for a named one
  std::string name;
  double value = 0.0;
  Place place;
};

/// For a line that is a whole program, and for a comment that contains one.
inline constexpr const char* kLineEndsLost =
    "one line has several moves: the file's line ends are lost; save it again with line ends";

/// Reused from line to line.
struct Block {
  std::array<const KnownCode*, kGroups> codes{};
  std::vector<Assignment> assignments;
  bool deletable = false;  ///< began with a slash
  std::size_t line = 0;

  bool has(char letter) const { return (present_ >> slot(letter) & 1U) != 0; }
  /// Only if has(letter).
  double value(char letter) const { return values_[slot(letter)]; }
  std::optional<double> find(char letter) const {
    return has(letter) ? std::optional(value(letter)) : std::nullopt;
  }
  Place place(char letter) const { return {line, columns_[slot(letter)]}; }
  operator Place() const { return {line}; }
  const KnownCode* code(Group group) const { return codes[static_cast<std::size_t>(group)]; }
  bool is(g::Name name) const {
    return code(name.group) != nullptr && code(name.group)->tenths == name.tenths;
  }
  bool has_axes() const;
  /// A polar radius or angle.
  bool has_polar() const { return has('@') || has('^'); }
  /// Z and no other axis.
  bool has_z_alone() const;

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

/// Whether a text has several moves, judged by its words G0 to G3 and X with a number.
bool holds_moves(std::string_view text);

/// Reads the words after `reader` to the end of the line.
/// \param tools_have_no_diameter G41 and G42 then have no effect and are not rejected.
void read_words(ValueReader reader, Block& block, bool tools_have_no_diameter = false);

}  // namespace chaintrue::gcode
