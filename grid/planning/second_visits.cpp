// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/planning/second_visits.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace chaintrue::grid {

std::vector<std::size_t> with_second_visits(std::size_t marks, std::size_t second) {
  if (3 * second > marks) {
    throw std::invalid_argument(fmt::format(
        "{} second visits of {} marks: three marks are needed for each", second, marks));
  }
  std::vector<std::size_t> visits;
  std::size_t made = 0;  // second visits so far
  for (std::size_t mark = 0; mark < marks; ++mark) {
    visits.push_back(mark);
    // The last of them is the first mark's, after all others.
    if (made + 1 >= second || (mark + 1) * second < (made + 1) * marks) continue;
    visits.push_back(made * marks / second + 1);
    ++made;
  }
  if (second > 0) visits.push_back(0);
  return visits;
}

}  // namespace chaintrue::grid
