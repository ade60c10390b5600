// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Tensions of the four belts at a reading, over the pull of the first pass. Motors pull some belts
/// to one force; the belts that hold carry the reaction, and on an upright frame the sled's weight.
///
/// Notation, level and of unit length but for the belt's slant
///   u_i  pull of belt i at tension 1: b_i / L_i (A_i - p) / |A_i - p|, b_i the level part of its length L_i
///   P    pull, of each belt that is pulled
///   w    the sled's weight along the sheet, upright frames only: kWeightOverPull
///   G    sum of u_h u_h' over the belts that hold
///
///   sum_i T_i u_i + (0, -w) = 0,   T_i = P of a belt that is pulled                         (1)
///   T_h = u_h' G^-1 f,   f = (0, w) - P sum of the pulled u_i                               (2)
///
/// (2) is exact for two belts that hold, the least tensions for three or four, and for one the part
/// along it. A belt only pulls: T_h below 0 is 0. If no belt is pulled all are 0: their tension is
/// unknown.
///
/// Exact to rounding with exact derivatives, at most kMostTension. The balance neglects elastic
/// belts and friction of the sled.
///
/// \code
///   const auto tension = tensions_of(machine, kLowerBeltsPulled, 1.0, {1500.0, 1000.0});
///   tension.tl.value;                    // about 1 in the middle
///   by_anchor(tension.tl, Belt::br);     // d(T_tl) / d(bottom right anchor), 1/mm
/// \endcode
#pragma once

#include <Eigen/Core>

#include "model/belts/belt_machine.hpp"
#include "model/dual.hpp"

namespace chaintrue::model::belts {

/// An upright frame: the firmware pulls the lower two while the upper two hold.
inline constexpr PerBelt<bool> kLowerBeltsPulled{false, false, true, true};

/// A sled of 11 kg weighs 110 N. Belts of EA = 178,900 N that stretch by 0.2 %, as those of eight
/// published runs do, are pulled with 360 N. These runs fit about equally from 0 to 0.4.
inline constexpr double kWeightOverPull = 0.3;

/// Between two anchors that hold, on the line through them, a belt would carry any force.
inline constexpr double kMostTension = 10.0;

/// A number with its derivatives by the level places of the four anchors, x and y of each. What
/// depends on the place less the anchors has the negative of their sum by the place.
using AnchorNumber = Dual<8>;

/// The first of an anchor's two derivatives.
constexpr std::size_t first_of(Belt anchor) { return 2 * static_cast<std::size_t>(anchor); }
inline Eigen::RowVector2d by_anchor(const AnchorNumber& number, Belt anchor) {
  return {number.d[first_of(anchor)], number.d[first_of(anchor) + 1]};
}

/// \throws std::logic_error if the anchors are not known.
PerBelt<AnchorNumber> tensions_of(const BeltMachine& machine, const PerBelt<bool>& pulled,
                                  double pull, FramePoint place);

}  // namespace chaintrue::model::belts
