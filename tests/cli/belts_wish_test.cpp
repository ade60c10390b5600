// SPDX-License-Identifier: GPL-3.0-or-later
// --wish-mm of four belts: reached, or what would reach it, and whether that then does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <regex>
#include <string>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

class BeltsWish : public testing_support::CommandFixture {
 protected:
  /// Places over the same part of the frame, read to 0.8 mm, made by the anchors of a log.
  void simulate(const std::string& grid, const std::string& file) {
    ASSERT_EQ(run("fit " + kLog + " -o truth.json --force").code, 0);
    const Outcome made = run("simulate --belts truth.json --grid " + grid + " --length-noise-mm 0.8 --seed 5 -o " + file);
    ASSERT_EQ(made.code, 0) << made.err;
  }
  std::string said(const std::string& file, const std::string& wish) {
    const Outcome fitted = run("fit " + file + " -o anchors.json --force --wish-mm " + wish);
    EXPECT_EQ(fitted.code, 0) << fitted.err;
    std::smatch found;
    const bool has = std::regex_search(fitted.err, found, std::regex("You wish for .*"));
    return has ? found.str() : "no word of the wish in:\n" + fitted.err;
  }
  const std::string kLog = CHAINTRUE_FIXTURES "/belts/thirty_one_places.json";
};

TEST_F(BeltsWish, IsReachedApartFromTheScaleThatNoBeltShows) {
  EXPECT_EQ(said(kLog, "2"), "You wish for 2 mm: reached. How large everything comes out only a taped distance can say.");
  std::string taped = content_of(kLog);
  const std::string points = "\"points\":";
  taped.insert(taped.find(points), R"("distances": [{"from": "bl", "to": "br", "distance_mm": 2943, "sigma_mm": 1}], )");
  write("taped.json", taped);
  EXPECT_EQ(said("taped.json", "2"), "You wish for 2 mm: reached.");
}

TEST_F(BeltsWish, ThatNoNumberOfPlacesReachesAsksForWhatIsWrong) {
  EXPECT_EQ(said(kLog, "0.001"),
            "You wish for 0.001 mm: not reached, and not by 124 places measured as well as these. Look for what else "
            "is wrong: chaintrue diagnose of the same belts.");
}

TEST_F(BeltsWish, IsReachedByThePlacesThatWereSaid) {
  simulate("4x4", "few.json");
  // Down to the first wish that sixteen places do not reach.
  double wish_mm = 4.0;
  std::string answer;
  do {
    wish_mm *= 0.85;
    ASSERT_GT(wish_mm, 0.01) << answer;
    answer = said("few.json", std::to_string(wish_mm));
  } while (answer.find(": reached") != std::string::npos);
  std::smatch places;
  ASSERT_TRUE(std::regex_search(answer, places, std::regex("not reached. About (32|48|64) places"))) << answer;
  simulate(std::to_string(std::stoi(places[1]) / 4) + "x4", "more.json");
  // Noise that is found from 27 checks is known to a seventh, from 59 to a tenth: twice these together.
  EXPECT_THAT(said("more.json", std::to_string(1.35 * wish_mm)), HasSubstr(": reached")) << answer;
}

}  // namespace
}  // namespace chaintrue
