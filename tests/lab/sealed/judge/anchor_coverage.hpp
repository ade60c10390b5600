// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Coverage of the 95 % intervals of four belts' anchors, with a cause at its usual size.
///
/// A frame of 2.95 by 2.07 m, places in a grid over its middle, one sigma of a belt's reading 0.5 mm.
/// The cause's belt, sign and size within its usual range are drawn, and the visit if it sets in.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sealed/judge/outcome.hpp"

namespace chaintrue::sealed {

/// A cause of the belts' table with the range of its usual sizes (docs/maslow4.md).
struct UsualCause {
  std::string_view effect = "nothing";
  std::string_view parameter;
  double least = 0.0;
  double most = 0.0;
  bool either_sign = false;
};
std::span<const UsualCause> usual_causes();

/// A session of `side` by `side` places. Its numbers are the shares of the coordinates within 1.96 sigmas of the
/// truth (`held`, and `held_alone` of anchors fitted alone) and the mean of (error / sigma)^2, `square`. \throws
/// std::logic_error where the session cannot be simulated or fitted.
[[nodiscard]] Outcome coverage_of(const std::string& effect, std::uint64_t seed, int side);

}  // namespace chaintrue::sealed
