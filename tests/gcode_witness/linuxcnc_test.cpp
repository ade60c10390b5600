// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Our interpreter compared with LinuxCNC's own, if that is installed: stored answers, random
/// programs, real files, and the output of compensate.
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "tests/gcode_witness/support/compared.hpp"
#include "tests/gcode_witness/support/corpus.hpp"
#include "tests/gcode_witness/support/output_run.hpp"

namespace chaintrue::witness {
namespace {

class LinuxCnc : public testing::Test {
 protected:
  void SetUp() override {
    if (!linuxcnc_missing().empty()) GTEST_SKIP() << linuxcnc_missing();
  }
};

TEST_F(LinuxCnc, AnswersAsItsStoredAnswers) {
  // Each program costs the interpreter a process; store_truth.py asks about all of them.
  constexpr std::size_t kEvery = 16;
  std::vector<Record> asked;
  std::vector<std::string> stored;
  for (const char* theme : kThemes) {
    const auto programs = stored_programs(CHAINTRUE_FIXTURES, theme);
    for (std::size_t i = 0; i < programs.size(); i += kEvery) {
      asked.push_back({programs[i].name, programs[i].text});
      stored.push_back(programs[i].answer);
    }
  }
  const auto answers = ask_linuxcnc(asked);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].text, stored[i])
        << asked[i].name << ": fixtures/gcode/corpus/store_truth.py stores it anew";
  }
}

TEST_F(LinuxCnc, GoesWhereWeGoOnRandomPrograms) {
  constexpr std::uint64_t kFirstSeed = 1000;
  constexpr std::uint64_t kCount = 60;
  const LanguageRun run = compare_language(kFirstSeed, kCount, 3);
  for (const std::string& failure : run.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(run.different, 0U) << "of " << kCount << " programs, seeds from " << kFirstSeed;
  EXPECT_GE(run.accepted * 100, kCount * kLeastAccepted);
}

TEST_F(LinuxCnc, GoesWhereWeGoOnRealFiles) {
  // A real file with G53 Z..., which we pass on as it is (differences.tsv).
  constexpr std::string_view kOfMachineHeights = "fluidnc_probe.nc";
  const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "gcode";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no real G-code files at " << folder;
  std::vector<Record> asked;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".canon" || extension == ".md" || extension == ".tsv") continue;
    asked.push_back({entry.path().filename().string(), grid::files::read_whole_file(entry.path())});
  }
  EXPECT_GE(asked.size(), 37U);
  gcode::Dialect dialect;
  dialect.tools_have_no_diameter = true;  // as in the tool table that LinuxCNC gets
  const auto answers = ask_linuxcnc(asked);
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const auto found = unlisted_difference(asked[i].text, read_truth(answers[i].text),
                                           ours(asked[i].text, dialect));
    if (asked[i].name == kOfMachineHeights) {
      EXPECT_TRUE(found) << "it agrees: compare it like the others";
    } else {
      EXPECT_EQ(found.value_or(""), "") << asked[i].name;
    }
  }
}

TEST_F(LinuxCnc, ReadsTheOutputOfCompensateAsWeDo) {
  constexpr std::uint64_t kFirstSeed = 1;
  const OutputRun run = compare_output(CHAINTRUE_FIXTURES, kFirstSeed, 30, true, 5);
  for (const std::string& failure : run.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(run.different, 0U) << "of " << run.outputs << ", seeds from " << kFirstSeed;
}

}  // namespace
}  // namespace chaintrue::witness
