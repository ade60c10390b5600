// SPDX-License-Identifier: GPL-3.0-or-later
// Every good file, cut off and damaged at bytes all over it: it is rejected with a message,
// or read as a valid object. No object that was read contains NaN or infinity: the writer rejects
// such a value, and every outcome is written.
#include <gtest/gtest.h>

#include <random>

#include "grid/files/whole_file.hpp"
#include "tests/grid_files/fixture_files.hpp"

namespace chaintrue::grid::files {
namespace {

constexpr std::uint64_t kDamageSeed = 20260102;

/// Bytes at which a file is damaged, evenly spaced. A log and a file of belts cost an adjustment of the
/// anchors each time it is read, 20 to 40 ms; tests/lab/torture damages any byte.
std::size_t most_places_of(const std::string& kind) {
  return kind == "maslow4" || kind == "belts" ? 15 : 100;
}

class Damage : public ::testing::TestWithParam<FixtureFile> {
 protected:
  void SetUp() override {
    text_ = read_whole_file(GetParam().path);
    step_ = 1 + text_.size() / most_places_of(GetParam().kind);
  }

  /// Reads the text and checks the properties of every outcome.
  void expect_refused_or_whole(const std::string& text, std::size_t place) const {
    Outcome outcome;
    ASSERT_NO_THROW(outcome = read_text(GetParam().kind, text, GetParam().path.string()))
        << "byte " << place;
    if (!outcome.problems.empty()) {
      for (const std::string& problem : outcome.problems) EXPECT_FALSE(problem.empty());
      return;
    }
    EXPECT_FALSE(outcome.written.empty()) << "byte " << place;
    EXPECT_EQ(outcome.written.find("nan"), std::string::npos) << "byte " << place;
    EXPECT_EQ(outcome.written.find("inf"), std::string::npos) << "byte " << place;
  }

  std::string text_;
  std::size_t step_ = 1;
};

TEST_P(Damage, RefusesFilesCutOffAnywhere) {
  for (std::size_t place = 0; place < text_.size(); place += step_) {
    expect_refused_or_whole(text_.substr(0, place), place);
  }
}

TEST_P(Damage, AnotherByteAnywhere) {
  SCOPED_TRACE(::testing::Message() << "seed " << kDamageSeed);
  constexpr std::string_view kTelling = "0123456789-+.,;:eE\"'{}[]#\\/ \n\r\tnN\x00\x7F\xC3\xFF";
  std::mt19937_64 bits(kDamageSeed);
  for (std::size_t place = 0; place < text_.size(); place += step_) {
    std::string damaged = text_;
    damaged[place] = kTelling[static_cast<std::size_t>(bits() % kTelling.size())];
    expect_refused_or_whole(damaged, place);
  }
}

TEST_P(Damage, NonNumbersAnywhere) {
  SCOPED_TRACE(::testing::Message() << "seed " << kDamageSeed);
  const std::string words[] = {
      "NaN", "1e999", "-Infinity", "null", "1e-999", "99999999999999999999",
      "",    "\n",    "{}",        "\"\""};
  std::mt19937_64 bits(kDamageSeed);
  for (std::size_t place = 0; place < text_.size(); place += step_) {
    std::string damaged = text_;
    const std::size_t length = std::min<std::size_t>(bits() % 8, text_.size() - place);
    damaged.replace(place, length, words[bits() % std::size(words)]);
    expect_refused_or_whole(damaged, place);
  }
}

INSTANTIATE_TEST_SUITE_P(Fixtures, Damage, ::testing::ValuesIn(fixtures_in("good")),
                         [](const auto& tested) { return test_name_of(tested.param); });

}  // namespace
}  // namespace chaintrue::grid::files
