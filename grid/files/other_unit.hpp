// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The actual unit of a file whose lengths are all too small, inferred from its bed.
#pragma once

namespace chaintrue::grid::files {

struct OtherUnit {
  const char* word;
  double mm;
};
/// A bed of 4 to 12 feet is 48 to 144 inches wide, or 122 to 366 centimetres; the smaller of two
/// beds that are as wide in both is taken for one in inches.
[[nodiscard]] inline OtherUnit other_unit(double bed_width) {
  constexpr double kWidestInInches = 145.0;
  return bed_width <= kWidestInInches ? OtherUnit{"inches", 25.4} : OtherUnit{"centimetres", 10.0};
}
/// The widest bed in centimetres, and one that remains half a metre in mm.
inline constexpr double kWidestOfOtherUnit = 370.0;

}  // namespace chaintrue::grid::files
