// SPDX-License-Identifier: GPL-3.0-or-later
// Sessions in which belts were pulled to two forces: how they are simulated, written and imported.
#include <gmock/gmock.h>


#include "grid/files/belts_file.hpp"
#include "tests/belts/two_pull_sessions.hpp"
#include "tests/cli/command_fixture.hpp"

namespace chaintrue::grid::two_pulls {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing_support::content_of;
using testing_support::Outcome;

TEST(TwoPulls, APassHasItsPullAndVisitsAreNumberedOn) {
  const MeasuredBelts belts =
      measured({{"belt_stretch", "", {{"elongation", 0.004}}}}, {1.0, kHarder}, 0.0, 1);
  ASSERT_EQ(belts.points.size(), 84U);
  EXPECT_EQ(different_pulls(belts), (std::vector<double>{1.0, kHarder}));
  for (std::size_t k = 0; k < 42; ++k) {
    const BeltPoint& first = belts.points[k];
    const BeltPoint& second = belts.points[k + 42];
    EXPECT_EQ(*second.order, static_cast<int>(k) + 42);
    // A belt that holds carries more as well: 0.6 of 0.4 % times its own tension, less the weight's part.
    EXPECT_LT(second.lengths_mm.tl, first.lengths_mm.tl);
    EXPECT_LT(second.lengths_mm.tr, first.lengths_mm.tr);
    // Level spans of belts with arm and heights: 0.6 of 0.4 % of the belt, to a twentieth.
    const double shorter = first.lengths_mm.bl - second.lengths_mm.bl;
    const double belt_mm = first.lengths_mm.bl - 153.4;
    EXPECT_NEAR(shorter, 0.6 * 0.004 * belt_mm, 0.05 * 0.6 * 0.004 * belt_mm);
  }
}

TEST(TwoPulls, AFileKeepsThePullInItsUnit) {
  MeasuredBelts belts = measured({}, {}, 0.5, 1);
  for (const BeltPull& pull : {BeltPull{1300.0, BeltPull::Unit::milliampere},
                               BeltPull{150.0, BeltPull::Unit::newton},
                               BeltPull{1.6, BeltPull::Unit::relative}}) {
    for (BeltPoint& point : belts.points) point.pull = pull;
    const MeasuredBelts read = files::parse_belts(files::write_belts(belts), "belts.json").belts;
    EXPECT_EQ(read.points.back().pull, pull);
  }
  belts.points[4].pull = BeltPull{1300.0, BeltPull::Unit::milliampere};
  try {
    (void)files::parse_belts(files::write_belts(belts), "belts.json");
    FAIL() << "a file of two units";
  } catch (const files::InputError& error) {
    EXPECT_THAT(error.problems().front().message(),
                AllOf(HasSubstr("/points/4"), HasSubstr("1300 mA"), HasSubstr("in one unit")));
  }
}

class TwoPullCommands : public testing_support::CommandFixture {
 protected:
  /// Readings as a machine prints them.
  void write_log(const std::string& name, const MeasuredBelts& belts, const std::string& head = "") {
    std::string log = head + "CLBM:[";
    for (const BeltPoint& point : belts.points) {
      const auto& l = point.lengths_mm;
      log += fmt::format(
          "{{bl:{:.2f}, br:{:.2f}, tr:{:.2f}, tl:{:.2f}}},", l.bl, l.br, l.tr, l.tl);
    }
    write(name, log + "]\n");
  }
  /// Of both passes each.
  void write_two_logs(const std::string& first_head = "", const std::string& second_head = "") {
    const MeasuredBelts both =
        measured({{"belt_stretch", "", {{"elongation", 0.004}}}}, {1.0, kHarder}, 0.3, 7);
    MeasuredBelts one = both;
    one.points.resize(42);
    write_log("first.log", one, first_head);
    MeasuredBelts two = both;
    two.points.erase(two.points.begin(), two.points.begin() + 42);
    write_log("second.log", two, second_head);
  }
  [[nodiscard]] MeasuredBelts read(const std::string& name) const {
    return files::parse_belts(content_of(folder_ / name), name).belts;
  }
};

TEST_F(TwoPullCommands, TwoLogsAreOneSession) {
  write_two_logs();
  const Outcome made = run("import maslow4 first.log second.log --pulls 1,1.6 -o belts.json");
  ASSERT_EQ(made.code, 0) << made.err;
  EXPECT_THAT(made.err, AllOf(HasSubstr("84 points read."), HasSubstr("One session of 2 pulls")));
  const MeasuredBelts belts = read("belts.json");
  EXPECT_EQ(*belts.points.back().order, 83);
  EXPECT_EQ(belts.points.back().pull, (BeltPull{1.6, BeltPull::Unit::relative}));
  ASSERT_EQ(run("diagnose belts.json -o diagnosis.json").code, 0);
  EXPECT_THAT(content_of(folder_ / "diagnosis.json"), HasSubstr("belt_stretch"));
}

TEST_F(TwoPullCommands, ALogThatPrintsTheCurrentSaysItByItself) {
  write_two_logs("$Maslow_Calibration_Current_Threshold=1300\n",
                 "[MSG:INFO: x]\n$/Maslow_Calibration_Current_Threshold=2080\n");
  ASSERT_EQ(run("import maslow4 first.log second.log -o belts.json").code, 0);
  const MeasuredBelts belts = read("belts.json");
  EXPECT_EQ(belts.points.front().pull, (BeltPull{1300.0, BeltPull::Unit::milliampere}));
  EXPECT_EQ(different_pulls(belts), (std::vector<double>{1.0, kHarder}));
  // Both in one paste.
  write("both.log",
        content_of(folder_ / "first.log") + "Run 2:\n" + content_of(folder_ / "second.log"));
  ASSERT_EQ(run("import maslow4 both.log --runs 1,2 -o pasted.json").code, 0);
  EXPECT_EQ(different_pulls(read("pasted.json")), (std::vector<double>{1.0, kHarder}));
  EXPECT_EQ(read("pasted.json").points.size(), 84U);
}

TEST_F(TwoPullCommands, WhatIsNoSessionIsRefused) {
  write_two_logs();
  const auto refused = [this](const std::string& arguments, const std::string& why) {
    const Outcome made = run("import maslow4 " + arguments + " -o x.json");
    EXPECT_EQ(made.code, 3) << arguments;
    EXPECT_THAT(made.err, HasSubstr(why)) << arguments;
    EXPECT_FALSE(exists("x.json")) << arguments;
  };
  refused("first.log second.log", "how hard belts were pulled in each run: --pulls");
  refused("first.log second.log --pulls 1", "a pull for each of the 2 runs");
  refused("first.log second.log --pulls 1,150N", "one number for each run");
  refused("first.log second.log --pulls 1,0", "one number for each run");
  refused("first.log second.log --pulls 1,1.6 --runs 1", "one log: of several");
  MeasuredBelts other = measured({}, {}, 0.3, 7);
  for (BeltPoint& point : other.points) {
    point.lengths_mm.bl += 300.0;
    point.lengths_mm.br += 300.0;
  }
  write_log("other.log", other);
  refused("first.log other.log --pulls 1,1.6", "runs of one frame");
}

TEST_F(TwoPullCommands, ASessionOfTwoPullsIsSimulated) {
  const std::string stated = CHAINTRUE_FIXTURES "/belts/thirty_one_places.json";
  ASSERT_EQ(run("simulate --belts " + stated +
                " --grid 6x5 --pulls 1,1.6 --effect anchor_flex:-:give_mm=2 -o belts.json")
                .code,
            0);
  EXPECT_EQ(different_pulls(read("belts.json")), (std::vector<double>{1.0, kHarder}));
  const Outcome wrong = run("simulate --belts " + stated + " --grid 6x5 --pulls 1,2N -o x.json");
  EXPECT_EQ(wrong.code, 3);
  EXPECT_THAT(wrong.err, HasSubstr("--pulls"));
}

}  // namespace
}  // namespace chaintrue::grid::two_pulls
