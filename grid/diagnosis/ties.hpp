// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where a sorted list is cut, what scores equally goes the same way.
///
/// Two phases of a wave half a turn apart have the same column but for its sign, and score equally but for rounding. Were
/// the list cut between them, the last bit of a sine would say which of the two signs is tried.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace chaintrue::grid::diagnosis {

/// Scores are squares of sigmas or logarithms of odds: rounding moves them by 1e-10, and a millionth tells nothing apart.
inline constexpr double kTied = 1e-6;

[[nodiscard]] inline bool tied(double a, double b) { return std::abs(a - b) < kTied; }

/// Of a list sorted by score: the first `most`, and what ties with the last of these.
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
