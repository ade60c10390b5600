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

namespace chaintrue::sealed {

/// A cause of the belts' table with the range of its usual sizes (docs/maslow4.md).
struct UsualCause {
  std::string_view effect;  ///< empty: nothing acts
  std::string_view parameter;
  double least = 0.0;
  double most = 0.0;
  bool either_sign = false;
};
[[nodiscard]] std::span<const UsualCause> usual_causes();

struct Coverage {
  int held = 0;         ///< coordinates within 1.96 sigmas of the truth
  int of = 0;           ///< five a session
  int held_alone = 0;   ///< the same of anchors fitted alone
  double square = 0.0;  ///< sum of (error / sigma)^2
};

/// Sessions of seeds first_seed, first_seed + 1, ..., `side` by `side` places each. \throws
/// std::logic_error where a session cannot be simulated or fitted.
[[nodiscard]] Coverage coverage_of(const UsualCause& cause,
                                   std::uint64_t first_seed,
                                   int sessions,
                                   int side);

}  // namespace chaintrue::sealed
