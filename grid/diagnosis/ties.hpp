// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Cuts sorted lists without splitting ties. Two phases of a wave half a turn apart have the same
/// column up to its sign and score equally up to rounding; a cut between them would depend on the
/// last bit of a sine.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "grid/containers.hpp"

namespace chaintrue::grid::diagnosis {

/// Scores are squares of sigmas or logarithms of odds: rounding changes them by 1e-10, and a
/// difference of a millionth is irrelevant.
inline constexpr double kTied = 1e-6;

inline bool tied(double a, double b) { return std::abs(a - b) < kTied; }

/// The `most` best of a list by a score, best first, and those that tie with the last.
template <typename List, typename Score>
void keep_best(List& list, std::size_t most, const Score& score) {
  stable_sort(list, descending(score));
  std::size_t count = std::min(most, list.size());
  while (count > 0 && count < list.size() &&
         tied(std::invoke(score, list[count]), std::invoke(score, list[most - 1])))
    ++count;
  list.resize(count);
}
/// By the first of each pair.
template <typename Other>
void keep_best(std::vector<std::pair<double, Other>>& scored, std::size_t most) {
  keep_best(scored, most, &std::pair<double, Other>::first);
}

}  // namespace chaintrue::grid::diagnosis
