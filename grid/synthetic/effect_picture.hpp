// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The change that one effect makes to the bed and to a square of 100 mm, and the size from which
/// it is identified: the numbers of `chaintrue effects ID`.
#pragma once

#include <array>
#include <vector>

#include "grid/synthetic/strength.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::synthetic {

/// A tool sent to a mark.
struct ShiftedMark {
  MarkPoint mark;
  /// Actual less commanded position of the tool, on the machine as stated ...
  Vector2d as_stated_mm;
  /// ... and after calibration of the settings on these marks.
  Vector2d calibrated_mm;
};

/// A square cut where the stated machine cuts it; corners counter-clockwise from the lower left.
struct ShiftedSquare {
  BedPoint centre;
  double size_mm = 100.0;
  std::array<Vector2d, 4> corner_shift_mm;
  /// Bottom, right, top, left, as cut.
  std::array<double, 4> side_mm{};
  /// From the lower left, from the lower right.
  std::array<double, 2> diagonal_mm{};
};

/// The strength over a regular grid of that many marks.
struct StrengthAt {
  int columns = 0;
  int rows = 0;
  EffectStrength strength;
};

struct EffectPicture {
  AppliedEffect applied;
  StatedNoise noise;
  int columns = 0;
  int rows = 0;
  /// Row by row from the bottom left.
  std::vector<ShiftedMark> marks;
  std::vector<ShiftedSquare> squares;
  std::vector<StrengthAt> strengths;
};

/// `values` in the order of the effect's parameters.
/// \throws std::invalid_argument if the effect cannot act on the machine or the machine cannot
/// reach its own bed.
EffectPicture picture_effect(const Machine& machine, const Effect& effect, EffectSide side,
                             const std::vector<double>& values, const StatedNoise& noise);

}  // namespace chaintrue::grid::synthetic
