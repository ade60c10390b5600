// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The output of compensate is the same program for our interpreter and for a reader as strict as
/// grbl's.
#include <gtest/gtest.h>

#include <string>

#include "tests/gcode_witness/follower/strict_reader.hpp"
#include "tests/gcode_witness/support/output_run.hpp"

namespace chaintrue::witness {
namespace {

constexpr std::uint64_t kFirstSeed = 1;

TEST(Output, IsReadAlikeByStrictReadersAndKeepsTheValuesOfItsWords) {
  const OutputRun run = compare_output(CHAINTRUE_FIXTURES, kFirstSeed, 80, false, 5);
  for (const std::string& failure : run.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(run.different, 0U) << "of " << run.outputs << ", seeds from " << kFirstSeed;
  EXPECT_GE(run.outputs, 60U);
}

TEST(StrictReader, RefusesWordsThatGrblRefuses) {
  std::string objection;
  for (const char* line : {"S2e-05", "G4 P1e-05", "G1 X--1", "g1 X2", "G1 X1 X2", "G1 X", "G1 X1,5",
                           "G1 X1.2.3", "(a(b)c)", "(open"}) {
    EXPECT_FALSE(follower::read_strictly(line, objection)) << line;
    EXPECT_FALSE(objection.empty()) << line;
  }
  EXPECT_FALSE(follower::read_strictly(std::string(81, ' '), objection));
}

TEST(StrictReader, ReadsNumbersAsGrblDoes) {
  EXPECT_EQ(follower::strict_number("-0.5"), -0.5);
  EXPECT_EQ(follower::strict_number("+.25"), 0.25);
  EXPECT_EQ(follower::strict_number("12"), 12.0);
  // Eight digits are kept, leading zeros not counted.
  EXPECT_DOUBLE_EQ(follower::strict_number("123456789").value(), 123456780.0);
  EXPECT_DOUBLE_EQ(follower::strict_number("0.000012345").value(), 0.000012345);
  EXPECT_FALSE(follower::strict_number("."));
  EXPECT_FALSE(follower::strict_number("1e5"));
  EXPECT_FALSE(follower::strict_number(""));
}

}  // namespace
}  // namespace chaintrue::witness
