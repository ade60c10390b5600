// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The corpus of small programs: our interpreter's moves compared with the stored ones of LinuxCNC;
/// and the stored ones with LinuxCNC itself, if it is installed.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/gcode_witness/support/canonical.hpp"
#include "tests/gcode_witness/support/linuxcnc.hpp"

namespace chaintrue::witness {
namespace {

const std::string kFolder = std::string(CHAINTRUE_FIXTURES) + "/gcode/corpus/";

/// Limit for endless programs, far below the usual budget.
constexpr std::uint64_t kSteps = 100'000;

std::vector<std::string> programs(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(kFolder + folder)) {
    if (entry.path().extension() == ".ngc") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string program(const std::string& folder, const std::string& name) {
  return read_file(kFolder + folder + "/" + name + ".ngc");
}

Answer truth(const std::string& folder, const std::string& name) {
  return read_truth(read_file(kFolder + folder + "/" + name + ".canon"));
}

Answer here(const std::string& folder, const std::string& name) {
  gcode::Dialect dialect;
  dialect.step_budget = kSteps;
  return ours(program(folder, name), dialect);
}

/// Rows of a table with a header line, by their first column.
std::map<std::string, std::vector<std::string>> table(const std::string& name) {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream lines(read_file(kFolder + name));
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    std::string key;
    std::getline(cells, key, '\t');
    std::vector<std::string>& row = rows[key];
    for (std::string cell; std::getline(cells, cell, '\t');) row.push_back(cell);
  }
  return rows;
}

using Rows = std::map<std::string, std::vector<std::string>>;

bool listed(const Rows& differences, const std::string& name, const std::string& how) {
  const auto row = differences.find(name);
  return row != differences.end() && row->second.at(0) == how;
}

TEST(Corpus, HoldsWhatItPromises) {
  EXPECT_GE(programs("accepted").size(), 120U);
  EXPECT_GE(programs("refused").size(), 60U);
}

TEST(Corpus, AcceptedProgramsGoWhereLinuxCncGoes) {
  const Rows differences = table("differences.tsv");
  for (const std::string& name : programs("accepted")) {
    SCOPED_TRACE(name + ":\n" + program("accepted", name));
    const Answer linuxcnc = truth("accepted", name);
    const Answer answer = here("accepted", name);
    EXPECT_TRUE(answer.accepted) << answer.refusal;
    const auto found = difference(linuxcnc, answer);
    if (listed(differences, name, "looser")) {
      EXPECT_FALSE(linuxcnc.accepted) << "LinuxCNC accepts it: strike it from differences.tsv";
    } else if (listed(differences, name, "moves")) {
      EXPECT_TRUE(linuxcnc.accepted && found) << "the moves agree: strike it from differences.tsv";
    } else {
      EXPECT_EQ(found.value_or(""), "");
    }
  }
}

TEST(Corpus, RefusedProgramsAreRefusedByBothWithTheLineAndTheProblem) {
  const Rows differences = table("differences.tsv");
  const Rows problems = table("refused.tsv");
  for (const std::string& name : programs("refused")) {
    SCOPED_TRACE(name + ":\n" + program("refused", name));
    const Answer linuxcnc = truth("refused", name);
    const Answer answer = here("refused", name);
    EXPECT_FALSE(answer.accepted);
    EXPECT_EQ(linuxcnc.accepted, listed(differences, name, "stricter"))
        << (linuxcnc.accepted ? "LinuxCNC accepts it" : linuxcnc.refusal);
    const auto row = problems.find(name);
    ASSERT_NE(row, problems.end()) << "refused.tsv says nothing of it";
    EXPECT_EQ(answer.problem, row->second.at(0)) << answer.refusal;
    EXPECT_EQ(fmt::format("{}", answer.problem_line), row->second.at(1)) << answer.refusal;
  }
}

TEST(Corpus, TablesNameNothingElse) {
  std::set<std::string> accepted;
  for (const auto& name : programs("accepted")) accepted.insert(name);
  std::set<std::string> refused;
  for (const auto& name : programs("refused")) refused.insert(name);
  for (const auto& [name, row] : table("refused.tsv")) EXPECT_TRUE(refused.contains(name)) << name;
  for (const auto& [name, row] : table("differences.tsv")) {
    SCOPED_TRACE(name);
    ASSERT_EQ(row.size(), 2U) << "a difference has its reason";
    EXPECT_THAT(row[0], testing::AnyOf("stricter", "looser", "moves"));
    EXPECT_TRUE(row[0] == "stricter" ? refused.contains(name) : accepted.contains(name));
  }
}

TEST(Corpus, StoredAnswersAreThoseOfTheLivingInterpreter) {
  if (!linuxcnc_missing().empty()) GTEST_SKIP() << linuxcnc_missing();
  std::vector<Record> asked;
  std::vector<std::string> stored;
  for (const std::string folder : {"accepted", "refused"}) {
    for (const std::string& name : programs(folder)) {
      asked.push_back({folder + "/" + name, program(folder, name)});
      stored.push_back(read_file(kFolder + folder + "/" + name + ".canon"));
    }
  }
  const auto answers = ask_linuxcnc(asked);
  for (std::size_t i = 0; i < answers.size(); ++i) {
    EXPECT_EQ(answers[i].text, stored[i])
        << asked[i].name << ": fixtures/gcode/corpus/store_truth.py stores it anew";
  }
}

}  // namespace
}  // namespace chaintrue::witness
