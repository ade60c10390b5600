// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Random programs: our interpreter compared with LinuxCNC's, by stored answers, and by new ones if
/// it is installed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/gcode_witness/support/compared.hpp"
#include "tests/gcode_witness/support/program_generator.hpp"

namespace chaintrue::witness {
namespace {

const std::string kCorpusFolder = std::string(CHAINTRUE_FIXTURES) + "/gcode/corpus/";

/// Programs with comparable answers, of each hundred.
constexpr std::size_t kLeastAccepted = 80;

void expect_same(const std::vector<Record>& programs, const std::vector<Record>& truths) {
  std::size_t accepted = 0;
  ASSERT_EQ(programs.size(), truths.size());
  for (std::size_t i = 0; i < programs.size(); ++i) {
    ASSERT_EQ(programs[i].name, truths[i].name);
    const Answer linuxcnc = read_truth(truths[i].text);
    accepted += linuxcnc.accepted ? 1U : 0U;
    const auto found = unlisted_difference(programs[i].text, linuxcnc, limited(programs[i].text));
    EXPECT_EQ(found.value_or(""), "") << programs[i].name << ":\n" << programs[i].text;
  }
  EXPECT_GE(accepted * 100, programs.size() * kLeastAccepted)
      << "a generator whose programs are refused tests little";
}

TEST(GeneratedPrograms, GoWhereLinuxCncWasStoredToGo) {
  const auto programs = read_records(read_file(kCorpusFolder + "generated.records"));
  EXPECT_GE(programs.size(), 200U);
  expect_same(programs, read_records(read_file(kCorpusFolder + "generated.canon")));
}

TEST(GeneratedPrograms, GoWhereTheLivingLinuxCncGoes) {
  if (!linuxcnc_missing().empty()) GTEST_SKIP() << linuxcnc_missing();
  constexpr std::uint64_t kFirstSeed = 1000;
  constexpr std::uint64_t kCount = 300;
  const LanguageRun run = compare_language(kFirstSeed, kCount, 3);
  for (const std::string& failure : run.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(run.different, 0U) << "of " << kCount << " programs, seeds from " << kFirstSeed;
  EXPECT_GE(run.accepted * 100, kCount * kLeastAccepted);
}

}  // namespace
}  // namespace chaintrue::witness
