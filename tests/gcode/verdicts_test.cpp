// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// 217 snippets, each a hazard of some dialect: the same verdict as LinuxCNC 2.9, except for the
/// differences listed here and explained in docs/gcode.md; and the same positions where LinuxCNC
/// reports them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"

namespace chaintrue::gcode {
namespace {

const std::filesystem::path kFile =
    std::filesystem::path(CHAINTRUE_SHARED_DATA) / "gcode" / "hazard_oracle.md";

struct Snippet {
  std::string shown;  ///< as in the file
  std::string text;
  std::string verdict;
  [[nodiscard]] bool refused() const { return verdict.starts_with("**ERROR**"); }
};

void append_utf8(std::string& text, unsigned code) {
  if (code < 0x80) {
    text.push_back(static_cast<char>(code));
  } else if (code < 0x800) {
    text.push_back(static_cast<char>(0xC0U | (code >> 6U)));
    text.push_back(static_cast<char>(0x80U | (code & 0x3FU)));
  } else {
    text.push_back(static_cast<char>(0xE0U | (code >> 12U)));
    text.push_back(static_cast<char>(0x80U | ((code >> 6U) & 0x3FU)));
    text.push_back(static_cast<char>(0x80U | (code & 0x3FU)));
  }
}

/// The snippets are written as Python string literals.
std::string unescaped(std::string_view text) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '\\') {
      result.push_back(text[i]);
      continue;
    }
    ++i;
    const std::map<char, char> simple = {
        {'n', '\n'}, {'t', '\t'}, {'r', '\r'}, {'\'', '\''}, {'\\', '\\'}};
    if (const auto found = simple.find(text[i]); found != simple.end()) {
      result.push_back(found->second);
      continue;
    }
    const std::size_t digits = text[i] == 'x' ? 2 : 4;
    unsigned code = 0;
    std::from_chars(text.data() + i + 1, text.data() + i + 1 + digits, code, 16);
    append_utf8(result, code);
    i += digits;
  }
  return result;
}

std::vector<Snippet> snippets() {
  std::vector<Snippet> all;
  std::ifstream file(kFile);
  for (std::string line; std::getline(file, line);) {
    const std::string arrow = "'` \u2192 ";
    const std::size_t end = line.find(arrow);
    if (!line.starts_with("- `'") || end == std::string::npos) continue;
    const std::string shown = line.substr(4, end - 4);
    all.push_back({shown, unescaped(shown), line.substr(end + arrow.size())});
  }
  return all;
}

/// Precedes each snippet: the stored verdicts had a feed rate and a motion mode too.
constexpr std::string_view kBefore = "F100\nG0 X0 Y0 Z0\n";

/// Snippet and a part of our message; empty where we accept and LinuxCNC rejects.
const std::map<std::string, std::string> kDifferent = {
    {"G17.1", "axes U, V and W"},
    {"G41.1 D2\\nG1 X10 Y0\\nG1 X10 Y10\\nG40 G1 X0", "cutter compensation"},
    {"G5 I0 J3 P0 Q-3 X1 Y1", "splines"},
    {"G5.1 X2 I1 J2", "splines"},
    {"G7", "lathe diameter"},
    {"G96 S100 D2000", "surface speed"},
    {"T9", ""},  // LinuxCNC has a tool table; controllers of these machines do not
};

TEST(Verdicts, AreLinuxCncsButForTheListedDifferences) {
  const auto all = snippets();
  if (all.empty()) GTEST_SKIP() << "no snippets at " << kFile;
  ASSERT_EQ(all.size(), 217U);
  for (const Snippet& snippet : all) {
    SCOPED_TRACE(snippet.shown + " -> " + snippet.verdict);
    Dialect dialect;
    dialect.step_budget = 10000;
    ProgramEvents events;
    const auto outcome = run_text(std::string(kBefore) + snippet.text + "\nM2\n", events, dialect);
    if (const auto different = kDifferent.find(snippet.shown); different != kDifferent.end()) {
      EXPECT_EQ(outcome.has_value(), snippet.refused());
      if (!outcome) {
        EXPECT_THAT(outcome.error().sentence, testing::HasSubstr(different->second));
      }
      continue;
    }
    EXPECT_EQ(outcome.has_value(), !snippet.refused())
        << (outcome ? "accepted" : outcome.error().message());
    if (!outcome) {
      EXPECT_GE(outcome.error().place.line, 3U) << "a refusal names its line";
      EXPECT_FALSE(outcome.error().sentence.empty());
    }
  }
}

/// The last STRAIGHT_FEED or STRAIGHT_TRAVERSE of the verdict, in the program's frame.
std::vector<double> last_place(const std::string& verdict) {
  std::vector<double> place;
  const std::size_t at =
      std::max(verdict.rfind("STRAIGHT_FEED(") + 1, verdict.rfind("STRAIGHT_TRAVERSE(") + 1);
  const std::size_t arc = verdict.rfind("ARC_FEED(");
  if (at == 0 || (arc != std::string::npos && arc > at)) return place;
  std::size_t from = verdict.find('(', at) + 1;
  for (int i = 0; i < 3; ++i) {
    double value = 0.0;
    const auto [end, error] =
        std::from_chars(verdict.data() + from, verdict.data() + verdict.size(), value);
    if (error != std::errc{}) return {};
    place.push_back(value);
    from = static_cast<std::size_t>(end - verdict.data()) + 2;
  }
  return place;
}

TEST(Verdicts, GoWhereLinuxCncGoes) {
  const auto all = snippets();
  if (all.empty()) GTEST_SKIP() << "no snippets at " << kFile;
  int compared = 0;
  for (const Snippet& snippet : all) {
    const auto place = last_place(snippet.verdict);
    // Snippets that shift the frame are compared in the machine frame by the files; here it is the
    // program's frame. Long verdicts are truncated in the file.
    const bool shifts = snippet.verdict.find("OFFSET") != std::string::npos ||
                        snippet.verdict.find("ROTATION") != std::string::npos ||
                        snippet.verdict.find("INCHES") != std::string::npos ||
                        snippet.text.find("G41") != std::string::npos;
    const bool whole = snippet.verdict.ends_with(')');
    if (snippet.refused() || place.empty() || shifts || !whole) continue;
    SCOPED_TRACE(snippet.shown + " -> " + snippet.verdict);
    ProgramEvents events;
    ASSERT_TRUE(run_text(std::string(kBefore) + snippet.text + "\nM2\n", events));
    ASSERT_FALSE(events.moves.empty());
    const Point to = events.moves.back().to;
    // The verdicts are written with four decimals.
    EXPECT_NEAR(to.x_mm, place[0], 6e-5);
    EXPECT_NEAR(to.y_mm, place[1], 6e-5);
    EXPECT_NEAR(to.z_mm, place[2], 6e-5);
    ++compared;
  }
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace chaintrue::gcode
