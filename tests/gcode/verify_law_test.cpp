// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// For every program that compensate accepts, at every tolerance from 0.005 to 1 mm and for every
/// controller, verify passes; a path moved by 1.5 tolerances fails. Three hundred programs here;
/// `gcode_verify_law COUNT SEED` runs any number.
#include <gtest/gtest.h>

#include "tests/gcode/random_program.hpp"

namespace chaintrue::gcode::testing_support {
namespace {

TEST(VerifyLaw, HoldsForRandomPrograms) {
  constexpr std::uint64_t kFirst = 1;
  constexpr std::uint64_t kCount = 300;
  int accepted = 0;
  for (std::uint64_t seed = kFirst; seed < kFirst + kCount; ++seed) {
    const std::string broken = broken_law(seed, accepted);
    ASSERT_EQ(broken, "") << "seed " << seed;
  }
  RecordProperty("accepted", accepted);
  // The corrections are within the limits nearly everywhere.
  EXPECT_GT(accepted, 270);
}

}  // namespace
}  // namespace chaintrue::gcode::testing_support
