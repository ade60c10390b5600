// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The corpus: our interpreter's moves and refusals compared with the stored answers of LinuxCNC.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "grid/files/whole_file.hpp"
#include "tests/gcode_witness/support/compared.hpp"
#include "tests/gcode_witness/support/corpus.hpp"

namespace chaintrue::witness {
namespace {

/// Rows of a table with a header line, by their first column.
using Rows = std::map<std::string, std::vector<std::string>>;

Rows table(const std::string& name) {
  Rows rows;
  std::istringstream lines(grid::files::read_whole_file(corpus_folder(CHAINTRUE_FIXTURES) + name));
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

/// How the answers differ, by differences.tsv: stricter, looser, moves, or empty.
std::string kind_of_difference(const Rows& differences, const std::string& name) {
  const auto row = differences.find(name);
  return row == differences.end() ? "" : row->second.at(0);
}

void expect_refused(const StoredProgram& program, const std::vector<std::string>& problem,
                    const std::string& how) {
  const Answer answer = limited(program.text);
  EXPECT_FALSE(answer.accepted);
  EXPECT_EQ(program.linuxcnc.accepted, how == "stricter")
      << (program.linuxcnc.accepted ? "LinuxCNC accepts it" : program.linuxcnc.refusal);
  EXPECT_EQ(answer.problem, problem.at(0)) << answer.refusal;
  EXPECT_EQ(fmt::format("{}", answer.problem_line), problem.at(1)) << answer.refusal;
}

void expect_accepted(const StoredProgram& program, const std::string& how) {
  const Answer answer = limited(program.text);
  EXPECT_TRUE(answer.accepted) << answer.refusal;
  const auto found = difference(program.linuxcnc, answer);
  if (how == "looser") {
    EXPECT_FALSE(program.linuxcnc.accepted)
        << "LinuxCNC accepts it: remove it from differences.tsv";
  } else if (how == "moves") {
    EXPECT_TRUE(program.linuxcnc.accepted && found)
        << "the moves agree: remove it from differences.tsv";
  } else {
    EXPECT_EQ(found.value_or(""), "");
  }
}

TEST(Corpus, GoesWhereLinuxCncGoesAndIsRefusedWithLineAndProblem) {
  const Rows differences = table("differences.tsv");
  const Rows refused = table("refused.tsv");
  std::set<std::string> names;
  for (const char* theme : kThemes) {
    for (const StoredProgram& program : stored_programs(CHAINTRUE_FIXTURES, theme)) {
      SCOPED_TRACE(fmt::format("{}.records, {}:\n{}", theme, program.name, program.text));
      EXPECT_TRUE(names.insert(program.name).second) << "two programs of this name";
      const std::string how = kind_of_difference(differences, program.name);
      const auto problem = refused.find(program.name);
      if (problem == refused.end()) {
        expect_accepted(program, how);
      } else {
        expect_refused(program, problem->second, how);
      }
    }
  }
  EXPECT_GE(names.size(), 620U);
  for (const auto& [name, row] : refused) EXPECT_TRUE(names.contains(name)) << name;
  for (const auto& [name, row] : differences) {
    SCOPED_TRACE(name);
    ASSERT_EQ(row.size(), 2U) << "a difference has its reason";
    EXPECT_THAT(row[0], testing::AnyOf("stricter", "looser", "moves"));
    EXPECT_TRUE(names.contains(name));
    EXPECT_EQ(row[0] == "stricter", refused.contains(name));
  }
}

TEST(Corpus, RandomProgramsGoWhereLinuxCncGoes) {
  std::size_t accepted = 0;
  const auto programs = stored_programs(CHAINTRUE_FIXTURES, "generated");
  EXPECT_GE(programs.size(), 200U);
  for (const StoredProgram& program : programs) {
    accepted += program.linuxcnc.accepted ? 1U : 0U;
    const auto found = unlisted_difference(program.text, program.linuxcnc, limited(program.text));
    EXPECT_EQ(found.value_or(""), "") << program.name << ":\n" << program.text;
  }
  EXPECT_GE(accepted * 100, programs.size() * kLeastAccepted)
      << "a generator whose programs are refused tests little";
}

}  // namespace
}  // namespace chaintrue::witness
