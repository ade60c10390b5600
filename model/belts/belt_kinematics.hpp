// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Belt lengths for a position of the tool, and the position for two belt lengths, as computed by
/// the controller of a Maslow 4.
///
/// Notation, for a belt with its anchor at A
///   m   level distance from A to the tool, |A - (x, y)|
///   e   arm and end extension
///   c   height of the anchor over the belt's end: z_mm + surface_mm
///
///   belt            L = sqrt((m - e)^2 + c^2)                                               (1)
///   belt_and_arm    L = sqrt(m^2 + c^2)                                                     (2)
///   span            L = m                                                                   (3)
///
/// Each is exact to rounding and inverted in closed form. A length depends on the position less the
/// anchor: its derivative by the anchor's x and y is the negative of that by the position.
///
/// The position for two lengths is where their circles meet below the line of the upper anchors (or
/// above that of the lower ones, if they are given).
///
/// Domain: tools farther than e from the anchor; lengths of at least the height c.
///
/// \code
///   const auto lengths = lengths_at(machine, {1500.0, 900.0});
///   const auto place = place_of_upper(machine, lengths->tl, lengths->tr);   // (1500, 900) again
///   if (!place) say(place.error().sentence());
/// \endcode
#pragma once

#include <Eigen/Core>
#include <string_view>
#include <tl/expected.hpp>

#include "model/belts/belt_machine.hpp"
#include "model/failure.hpp"

namespace chaintrue::model {

enum class BeltReason {
  inside_the_arm,       ///< the tool is nearer to the anchor than arm and extension are long
  shorter_than_height,  ///< no belt of that length comes down from its anchor
  circles_do_not_meet,  ///< circles of the two lengths do not intersect
};
MechanismReason named(BeltReason reason);
using BeltFailure = Failure<BeltReason>;

/// A length as the machine prints it, mm, with d(length)/d(place).
struct BeltReading {
  double length_mm = 0.0;
  Eigen::RowVector2d by_place = Eigen::RowVector2d::Zero();
};

/// The length that the machine prints for a belt with the tool at a place. \throws std::logic_error
/// if the anchors are not known.
[[nodiscard]] tl::expected<BeltReading, BeltFailure> reading_at(const BeltMachine& machine,
                                                                Belt belt, FramePoint place);
/// All four, without derivatives.
[[nodiscard]] tl::expected<PerBelt<double>, BeltFailure> lengths_at(const BeltMachine& machine,
                                                                    FramePoint place);

/// m for a printed length; the anchors' positions need not be known.
[[nodiscard]] tl::expected<double, BeltFailure> span_of(const BeltMachine& machine, Belt belt,
                                                        double length_mm);

/// The intersection of two circles about these anchors, to the right of the line from `first` to
/// `second`.
[[nodiscard]] tl::expected<FramePoint, BeltFailure> crossing(FramePoint first, double first_mm,
                                                             FramePoint second, double second_mm);

/// The position that the machine computes: from the upper two belts.
[[nodiscard]] tl::expected<FramePoint, BeltFailure> place_of_upper(const BeltMachine& machine,
                                                                   double tl_mm, double tr_mm);

}  // namespace chaintrue::model
