// SPDX-License-Identifier: GPL-3.0-or-later
// Evenings as their owners go through them, from the file in their hand to the numbers to type in: worn links, a chain
// that jumped a tooth while the marks were cut, a Maslow 4, and a machine with nothing wrong. Counted are the commands and the seconds; the
// first screen of a map has to say how far off the machine is, whether it is safe to cut, and what comes next, in
// the words of a workshop.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;
using testing_support::CommandFixture;
using testing_support::content_of;
using testing_support::Outcome;

/// Where a terminal of 24 lines of 80 ends for a reader who does not scroll, in words.
constexpr std::size_t kWordsBeforeTheFold = 60;

/// An owner who waits longer thinks that it hangs; these three take a second of processor time each on one core, and
/// test machines run four things at once.
constexpr double kPatienceSeconds = 30.0;

const char* const kWordsToLookUp[] = {"rms",    "sigma",      "residual",  "held out", "stated",
                                      "nominal", "compliance", "chebyshev", "likeness"};

std::string first_words(const std::string& text, std::size_t most) {
  std::istringstream words(text);
  std::string result;
  std::string word;
  for (std::size_t k = 0; k < most && words >> word; ++k) result += word + " ";
  return result;
}

class Evening : public CommandFixture {
 protected:
  /// Runs the next command of the evening.
  Outcome next(const std::string& line) {
    const auto began = std::chrono::steady_clock::now();
    Outcome ran = run(line);
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    ++commands_;
    return ran;
  }
  void expect_plain(const std::string& text) const {
    for (const char* word : kWordsToLookUp)
      EXPECT_FALSE(std::regex_search(text, std::regex("\\b" + std::string(word) + "\\b"))) << word << " in:\n" << text;
  }
  /// The counts, for whoever reads the log; `commands` is what the way has.
  void expect_short(int commands) {
    EXPECT_EQ(commands_, commands);
    EXPECT_LT(seconds_, kPatienceSeconds);
    std::printf("%d commands, %.1f seconds\n", commands_, seconds_);
    RecordProperty("commands", commands_);
  }
  /// Writes down what the owner measured.
  void measure(const std::string& evening) const {
    write("shop/marks.csv", content_of(std::string(CHAINTRUE_FIXTURES "/start/") + evening + ".csv"));
  }

 private:
  int commands_ = 0;
  double seconds_ = 0.0;
};

/// The size after `words` in a sentence, in mm; minus one where there is none.
double mm_after(const std::string& text, const std::string& words) {
  std::smatch found;
  return std::regex_search(text, found, std::regex(words + " about ([0-9.]+) mm")) ? std::stod(found[1]) : -1.0;
}

constexpr const char* kStart = "start " CHAINTRUE_FIXTURES "/good/groundcontrol_ring.ini shop";
constexpr const char* kFit = "fit shop/marks.csv --machine shop/machine.json --causes -o shop/map.json";

TEST_F(Evening, OfAWornChainEndsWithNumbersToTypeIn) {
  const Outcome started = next(kStart);
  ASSERT_EQ(started.code, 0) << started.err;
  EXPECT_THAT(started.err, HasSubstr(std::string("Next: chaintrue ") + kFit));
  measure("worn_chain");
  const Outcome fitted = next(kFit);
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  const std::string screen = first_words(fitted.err, kWordsBeforeTheFold);
  // Of a machine whose right links are 0.2 % longer than it believes; the marks are read to half a millimetre.
  EXPECT_NEAR(mm_after(screen, "misses by"), 4.3, 1.0) << screen;
  EXPECT_LT(mm_after(screen, "With this map it misses by"), 0.5) << screen;
  EXPECT_THAT(fitted.err, AllOf(HasSubstr("worn"), HasSubstr("Next: chaintrue export groundcontrol shop/map.json")));
  expect_plain(fitted.err);
  const Outcome typed = next("export groundcontrol shop/map.json");
  EXPECT_EQ(typed.code, 0) << typed.err;
  EXPECT_THAT(typed.out, HasSubstr("[Maslow Settings]"));
  expect_short(3);
}

TEST_F(Evening, OfAChainThatJumpedSaysSoAndMakesATrueMap) {
  ASSERT_EQ(next(kStart).code, 0);
  measure("slipped_tooth");
  const Outcome fitted = next(kFit);
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_THAT(fitted.err, HasSubstr("jumped over teeth of a sprocket during the measurement on the left (-1 link"));
  // The map of the same marks with the jump in it misses by 0.9 mm.
  EXPECT_LT(mm_after(fitted.err, "With this map it misses by"), 0.5) << fitted.err;
  expect_plain(fitted.err);
  EXPECT_EQ(next("export groundcontrol shop/map.json").code, 0);
  expect_short(3);
}

TEST_F(Evening, OfAMaslow4EndsWithLinesToPaste) {
  ASSERT_EQ(next("import maslow4 " CHAINTRUE_FIXTURES "/good/maslow4_log.txt --settings " CHAINTRUE_FIXTURES
                 "/machines/maslow.yaml -o belts.json")
                .code,
            0);
  const Outcome fitted = next("fit belts.json -o anchors.json");
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_THAT(fitted.err, HasSubstr("Next: chaintrue export maslow4 anchors.json"));
  const Outcome typed = next("export maslow4 anchors.json");
  EXPECT_EQ(typed.code, 0) << typed.err;
  EXPECT_THAT(typed.out, HasSubstr("$/kinematics/MaslowKinematics/tlX="));
  expect_short(3);
}

// What an owner reads before scrolling, of every verb with an answer.
TEST_F(Evening, FirstScreensAreInTheWordsOfAWorkshop) {
  ASSERT_EQ(next(kStart).code, 0);
  for (const char* evening : {"worn_chain", "slipped_tooth", "bent_beam", "long_tape", "nothing_wrong", "marks"}) {
    measure(evening);
    const Outcome found = next("diagnose shop/marks.csv --machine shop/machine.json -o shop/diagnosis.json --force");
    ASSERT_EQ(found.code, 0) << found.err;
    const std::string screen = first_words(found.out, kWordsBeforeTheFold);
    expect_plain(screen);
    EXPECT_THAT(screen, StartsWith("Your machine misses by about ")) << evening;
    EXPECT_THAT(found.out, HasSubstr("What to do now")) << evening;
    EXPECT_THAT(found.out, Not(HasSubstr("likeness"))) << evening;
  }
  const std::string fixtures = CHAINTRUE_FIXTURES;
  ASSERT_EQ(next("fit " + fixtures + "/grids/seven_by_four.json -o map.json").code, 0);
  const Outcome checked = next("check map.json " + fixtures + "/grids/five_new_points.json");
  EXPECT_THAT(checked.out, StartsWith("The map is still valid"));
  expect_plain(first_words(checked.out, kWordsBeforeTheFold));
}

TEST_F(Evening, FirstScreensOfFourBeltsAreInTheWordsOfAWorkshop) {
  const std::string belts = std::string(CHAINTRUE_FIXTURES) + "/belts/thirty_one_places.json";
  const Outcome fitted = next("fit " + belts + " -o anchors.json --wish-mm 0.5");
  EXPECT_THAT(first_words(fitted.err, kWordsBeforeTheFold),
              AllOf(StartsWith("Your machine misses by about "), HasSubstr("You wish for 0.5 mm: reached")));
  const Outcome found = next("diagnose " + belts + " -o diagnosis.json");
  EXPECT_THAT(found.out, AllOf(StartsWith("Your machine misses by about "), HasSubstr(" mm. Most likely "), HasSubstr("What to do now"), Not(HasSubstr("likeness"))));
  const Outcome checked = next("check anchors.json " + belts);
  EXPECT_THAT(checked.out, StartsWith("The anchors still hold"));
  for (const std::string* text : {&fitted.err, &found.out, &checked.out})
    expect_plain(first_words(*text, kWordsBeforeTheFold));
}

TEST_F(Evening, WithNothingWrongAsksForNoMap) {
  ASSERT_EQ(next(kStart).code, 0);
  measure("nothing_wrong");
  const Outcome fitted = next(kFit);
  ASSERT_EQ(fitted.code, 0) << fitted.err;
  EXPECT_THAT(first_words(fitted.err, kWordsBeforeTheFold), HasSubstr("Your machine needs no map"));
  EXPECT_THAT(fitted.err, Not(HasSubstr("Found, ")));
  expect_plain(fitted.err);
  expect_short(2);
}

}  // namespace
}  // namespace chaintrue
