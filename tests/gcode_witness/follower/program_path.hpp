// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where a G-code program leads the tool: an interpreter of its own, written from the language's
/// definition alone and sharing no line with tools/gcode.
///
/// Source: T. Kramer, F. Proctor, E. Messina, The NIST RS274NGC Interpreter - Version 3, NISTIR 6556,
/// 2000. Beyond it, as LinuxCNC's documentation describes them: the semicolon, P turns of arcs, G73,
/// G90.1 and G91.1, and G10 L2 R. O-words, polar words and probing are refused.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace chaintrue::follower {

/// x, y, z in mm in the machine's frame.
using Place = std::array<double, 3>;

struct Piece {
  bool rapid = false;
  std::size_t line = 0;
  double feed_mm_per_min = 0.0;
  /// From where the last piece ended; arcs as chords within kChordMm of them.
  std::vector<Place> places;
  /// The line says X or Y: until one does, nobody knows where the tool stands.
  bool says_xy = false;
};

/// What the chords of an arc lie off it at most.
inline constexpr double kChordMm = 5e-4;

/// \throws std::runtime_error with the line where the program is not understood.
[[nodiscard]] std::vector<Piece> program_path(const std::string& program);

/// One line of places through all pieces: from the end of the first piece that says X or Y, or from
/// the machine's zero where the program cuts before that.
[[nodiscard]] std::vector<Place> joined(const std::vector<Piece>& pieces);

}  // namespace chaintrue::follower
