// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The two spaces, kept apart as types: points on the bed and pairs of chain lengths.
///
/// Frame: origin at the bed's centre, x to the right, y up the sheet, mm. A chain length is the
/// unstretched chain from the pin at 12 o'clock to the chain's end at the ring (the ring's radius
/// is not part of it), plus the machine's chain_zero.
#pragma once

namespace chaintrue::model {

/// A point on the bed.
struct BedPoint {
  double x_mm = 0.0;
  double y_mm = 0.0;
};

/// A mark, or any point in its sheet's own coordinates: the numbers written on the paper.
/// SheetPlacement (model/calibration) maps it to the bed.
struct MarkPoint {
  double x_mm = 0.0;
  double y_mm = 0.0;
};

/// The mark if the sheet's coordinates are the bed's.
constexpr BedPoint identity_placement(MarkPoint mark) { return {mark.x_mm, mark.y_mm}; }
constexpr MarkPoint identity_placement(BedPoint place) { return {place.x_mm, place.y_mm}; }

enum class Side { left, right };

/// The lengths paid out by the two motors.
struct ChainLengths {
  double left_mm = 0.0;
  double right_mm = 0.0;
  constexpr double& operator[](Side side) { return side == Side::left ? left_mm : right_mm; }
  constexpr double operator[](Side side) const { return side == Side::left ? left_mm : right_mm; }
};

/// One value for each chain, addressed by side: `state[Side::left]`.
template <class T>
struct PerSide {
  T left{};
  T right{};
  constexpr T& operator[](Side side) { return side == Side::left ? left : right; }
  constexpr const T& operator[](Side side) const { return side == Side::left ? left : right; }
};

inline constexpr Side kSides[] = {Side::left, Side::right};

}  // namespace chaintrue::model

/// Exported: these names are used throughout chaintrue.
namespace chaintrue {
using model::BedPoint;
using model::ChainLengths;
using model::kSides;
using model::MarkPoint;
using model::PerSide;
using model::Side;
}  // namespace chaintrue
