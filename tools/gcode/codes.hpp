// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tables of G and M codes: modal group, axis words, and the reason for a refusal.
#pragma once

#include <cstdint>
#include <string>

namespace chaintrue::gcode {

/// Codes of one group exclude each other within a block.
enum class GGroup : std::uint8_t {
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
};
inline constexpr std::size_t kGGroups = 15;

enum class MGroup : std::uint8_t { stop, spindle, tool, coolant, override, output, state, flow };
inline constexpr std::size_t kMGroups = 8;

struct GCode {
  int tenths;  ///< 1 is 10, 91.1 is 911
  GGroup group;
  bool takes_axes;
  const char* refusal;  ///< why it is not supported; null if it is
};

struct MCode {
  int number;
  MGroup group;
  const char* refusal;
};

/// G73 and G81 to G89; a motion is given in tenths.
[[nodiscard]] constexpr bool is_cycle(int motion) {
  return motion == 730 || (motion >= 810 && motion <= 890);
}
[[nodiscard]] constexpr bool is_arc(int motion) { return motion == 20 || motion == 30; }

/// Null if the code is unknown.
[[nodiscard]] const GCode* find_g(int tenths);
[[nodiscard]] const MCode* find_m(int number);

/// `G1`, `G91.1`
[[nodiscard]] std::string g_name(int tenths);

}  // namespace chaintrue::gcode
