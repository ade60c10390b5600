// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A fixed number of mutated programs, the same in every run.
#include <gtest/gtest.h>

#include <chrono>

#include "tests/fuzz/gcode_fuzz.hpp"

namespace chaintrue::gcode::fuzz {
namespace {

TEST(GcodeFuzz, NothingCrashesHangsOrWritesNonsense) {
  constexpr std::uint64_t kSeed = 20260;
  constexpr int kPrograms = 2000;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  Mutator mutator(seeds(), kSeed);
  for (int i = 0; i < kPrograms; ++i) {
    const std::string program = mutator.next();
    const auto begin = std::chrono::steady_clock::now();
    const std::string wrong = run(program);
    const auto took = std::chrono::steady_clock::now() - begin;
    ASSERT_EQ(wrong, "") << "program " << i << ":\n" << program;
    // A run takes about a millisecond; more than a hundred thousand times that is a hang even on a
    // busy machine.
    ASSERT_LT(took, std::chrono::seconds(100)) << "program " << i << ":\n" << program;
  }
}

TEST(GcodeFuzz, TheSeedsThemselvesRun) {
  for (const std::string& program : seeds()) EXPECT_EQ(run(program), "") << program;
}

}  // namespace
}  // namespace chaintrue::gcode::fuzz
