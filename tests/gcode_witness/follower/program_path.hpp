// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The path of a G-code program: an independent interpreter, written from the language's definition
/// alone, without code of tools/gcode.
///
/// Source: T. Kramer, F. Proctor, E. Messina, The NIST RS274NGC Interpreter - Version 3, NISTIR 6556,
/// 2000. Beyond it, as LinuxCNC's documentation describes them: the semicolon, P turns of arcs, G73,
/// G90.1 and G91.1, and G10 L2 R. O-words, polar words and probing are rejected.
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
  /// From the end of the previous piece; arcs as chords within kChordMm of them.
  std::vector<Place> places;
  /// The line states X or Y: until one does, the tool's position is unknown.
  bool says_xy = false;
};

/// Largest distance of an arc's chords from it.
inline constexpr double kChordMm = 5e-4;

/// \throws std::runtime_error with the line if the program is not understood.
std::vector<Piece> program_path(const std::string& program);

/// All pieces as one line of positions: from the end of the first piece that states X or Y, or from
/// the machine's zero if the program cuts before that.
std::vector<Place> joined(const std::vector<Piece>& pieces);

}  // namespace chaintrue::follower
