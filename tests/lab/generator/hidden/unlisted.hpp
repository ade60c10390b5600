// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Disturbances that are in no catalogue: positions where the board or the frame under the sled
/// moves the bit off its mark. The tool's shift is `size_mm` at its maximum or per its own unit.
#pragma once

#include <span>
#include <vector>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::generator {

enum class Oddity { dent, wavy_board, fold, edge, periodic_in_x };
inline constexpr std::size_t kOddities = 5;

struct Unlisted {
  Oddity oddity = Oddity::dent;
  double size_mm = 0.0;
  Vec2 centre;                 ///< of a dent; a point of a fold's line
  double direction_rad = 0.0;  ///< of a wave's run, across a fold
  double extent_mm = 0.0;      ///< of a dent, an edge; wavelength of a wave
  double phase_rad = 0.0;
};

/// Distance of the bit from its mark at a position.
[[nodiscard]] Vec2 shift(const Unlisted& what, Vec2 place);
/// Its position and extent; the size is 1 mm.
[[nodiscard]] Unlisted draw_oddity(Oddity oddity, Dice& dice);

}  // namespace chaintrue::generator
