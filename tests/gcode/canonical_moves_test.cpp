// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The moves of real files compared with those of LinuxCNC's own interpreter (version 2.9), stored
/// next to the files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/gcode/corpus.hpp"
#include "tests/gcode/program_events.hpp"

namespace chaintrue::gcode {
namespace {

using testing_support::kCorpus;
using testing_support::test_name;

/// The documented accuracy; the stored values have 17 digits and were converted through inches.
constexpr double kSamePlaceMm = 1e-6;

struct CanonicalMove {
  std::string kind;
  std::size_t line = 0;
  std::vector<double> numbers;  // x y z, and cx cy for arcs
  int turns = 0;
  double feed = -1.0;
};

std::vector<CanonicalMove> read_canon(const std::filesystem::path& path, std::string& error) {
  std::vector<CanonicalMove> moves;
  std::ifstream file(path);
  for (std::string text; std::getline(file, text);) {
    if (text.starts_with("ERROR")) error = text;
    std::istringstream words(text);
    words.imbue(std::locale::classic());
    CanonicalMove move;
    words >> move.kind;
    if (move.kind != "RAPID" && move.kind != "FEED" && move.kind != "ARC") continue;
    words >> move.line;
    for (std::string word; words >> word;) {
      if (word == "C") continue;
      if (word.starts_with("turns")) {
        move.turns = std::stoi(word.substr(5));
      } else if (word.starts_with("F")) {
        move.feed = std::stod(word.substr(1));
      } else {
        move.numbers.push_back(std::stod(word));
      }
    }
    moves.push_back(move);
  }
  return moves;
}

CanonicalMove canonical(const Move& move) {
  const std::map<MoveKind, std::string> names = {{MoveKind::rapid, "RAPID"},
                                                 {MoveKind::feed, "FEED"},
                                                 {MoveKind::arc, "ARC"},
                                                 {MoveKind::probe, "PROBE"}};
  CanonicalMove result{
      names.at(move.kind), move.line, {move.to.x_mm, move.to.y_mm, move.to.z_mm}, 0, -1.0};
  if (move.kind == MoveKind::feed || move.kind == MoveKind::arc) result.feed = move.feed.value;
  if (move.arc) {
    result.numbers.push_back(move.arc->centre.x_mm);
    result.numbers.push_back(move.arc->centre.y_mm);
    result.turns = move.arc->turns;
  }
  return result;
}

/// Files that LinuxCNC accepts and we reject, each with the reason, which docs/gcode.md explains.
const std::map<std::string, std::string> kRefused = {
    {"linuxcnc_nurbs-xy.ngc", "NURBS are not supported"},
    {"linuxcnc_bad_no_feed.ngc",
     "no feed rate"},  // LinuxCNC's rs274 rejects it too, its Python module does not check
};

class CanonicalMoves : public testing::TestWithParam<std::string> {};

TEST_P(CanonicalMoves, EqualLinuxCncs) {
  const std::filesystem::path path = kCorpus / GetParam();
  std::string error;
  const auto expected = read_canon(path.string() + ".canon", error);
  Dialect dialect;
  dialect.tools_have_no_diameter = true;  // the stored moves were made with such a tool table
  auto source = LineSource::from_file(path.string());
  ASSERT_TRUE(source) << source.error().message();
  ProgramEvents events;
  const auto outcome = run_program(*source, dialect, events);
  const std::string name = GetParam();
  if (const auto refused = kRefused.find(name); refused != kRefused.end()) {
    ASSERT_FALSE(outcome);
    EXPECT_THAT(outcome.error().message(), testing::HasSubstr(refused->second));
    return;
  }
  EXPECT_EQ(outcome.has_value(), error.empty())
      << (outcome ? "accepted, but LinuxCNC says " + error : outcome.error().message());
  const bool compare_count = error.empty();
  if (compare_count) {
    ASSERT_EQ(events.moves.size(), expected.size());
  }
  for (std::size_t i = 0; i < std::min(expected.size(), events.moves.size()); ++i) {
    const CanonicalMove& want = expected[i];
    const CanonicalMove got = canonical(events.moves[i]);
    SCOPED_TRACE("move " + std::to_string(i) + ", line " + std::to_string(got.line));
    ASSERT_EQ(got.kind, want.kind);
    ASSERT_EQ(got.line, want.line);
    ASSERT_EQ(got.turns, want.turns);
    for (std::size_t k = 0; k < std::min(got.numbers.size(), want.numbers.size()); ++k) {
      ASSERT_NEAR(got.numbers[k], want.numbers[k], kSamePlaceMm);
    }
    // Feed rates are up to 2e6 mm/min here: compared relatively.
    if (want.feed > 0.0) {
      ASSERT_NEAR(got.feed, want.feed, 1e-9 * want.feed);
    }
  }
}

std::vector<std::string> files() {
  std::vector<std::string> names;
  if (!std::filesystem::exists(kCorpus)) return names;
  for (const auto& entry : std::filesystem::directory_iterator(kCorpus)) {
    const std::string name = entry.path().filename().string();
    if (name.ends_with(".canon")) names.push_back(name.substr(0, name.size() - 6));
  }
  std::sort(names.begin(), names.end());
  return names;
}

INSTANTIATE_TEST_SUITE_P(Corpus, CanonicalMoves, testing::ValuesIn(files()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(CanonicalMoves);

TEST(CorpusPrograms, Exist) {
  if (!std::filesystem::exists(kCorpus)) GTEST_SKIP() << "no real G-code files at " << kCorpus;
  EXPECT_GE(files().size(), 37U);
}

}  // namespace
}  // namespace chaintrue::gcode
