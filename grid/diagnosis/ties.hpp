// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Cuts sorted lists without splitting ties. Two phases of a wave half a turn apart have the same
/// column up to its sign and score equally up to rounding; a cut between them would depend on the
/// last bit of a sine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chaintrue::grid::diagnosis {

/// Scores are squares of sigmas or logarithms of odds: rounding changes them by 1e-10, and a
/// difference of a millionth is irrelevant.
inline constexpr double kTied = 1e-6;

[[nodiscard]] inline bool tied(double a, double b) { return std::abs(a - b) < kTied; }

/// The first `most` of a list sorted by score, and those that tie with the last.
template <typename List, typename Score>
[[nodiscard]] std::size_t count_with_ties(const List& sorted,
                                          std::size_t most,
                                          const Score& score) {
  std::size_t count = std::min(most, sorted.size());
  if (count == 0) return 0;
  const double last = score(sorted[count - 1]);
  while (count < sorted.size() && tied(score(sorted[count]), last)) ++count;
  return count;
}

}  // namespace chaintrue::grid::diagnosis
