// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// gcode_verify_law [COUNT [FIRST_SEED]]: the law of verify_law_test.cpp over many programs. Prints
/// each program that violates it, with its seed; exit code 1 if there is one.
#include <fmt/format.h>

#include <cstdlib>

#include "tests/gcode/random_program.hpp"

int main(int count, char** words) {
  const std::uint64_t most = count > 1 ? std::strtoull(words[1], nullptr, 10) : 10000;
  const std::uint64_t first = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
  int accepted = 0;
  int broken = 0;
  for (std::uint64_t seed = first; seed < first + most; ++seed) {
    const std::string story = chaintrue::gcode::testing_support::broken_law(seed, accepted);
    if (story.empty()) continue;
    ++broken;
    fmt::print("{}\n", story);
  }
  fmt::print("seeds {} to {}: {} programs accepted, {} break the law\n",
             first,
             first + most - 1,
             accepted,
             broken);
  return broken == 0 ? 0 : 1;
}
