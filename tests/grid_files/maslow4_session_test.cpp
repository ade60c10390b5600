// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of a Maslow 4's calibration as one session: pulls, visits, and what is no session.
#include "grid/files/maslow4_session.hpp"

#include <gmock/gmock.h>

#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files::session {
namespace {

using ::testing::HasSubstr;

std::string fixture() {
  return read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / "good/maslow4_log.txt");
}

std::vector<Maslow4Import> twice(const std::string& head = "") {
  const Maslow4Import run = parse_maslow4(head + fixture(), "log.txt");
  return {run, run};
}

template <class Refused>
std::string refusal(Refused refused) {
  try {
    refused();
  } catch (const InputError& error) {
    return error.problems().front().message();
  }
  return "";
}

TEST(Maslow4Session, PullsHaveOneUnit) {
  using Unit = BeltPull::Unit;
  EXPECT_EQ(pulls_of("1,1.6", "--pulls"),
            (std::vector<BeltPull>{{1.0, Unit::relative}, {1.6, Unit::relative}}));
  EXPECT_EQ(pulls_of("1300mA,1900mA", "--pulls"),
            (std::vector<BeltPull>{{1300.0, Unit::milliampere}, {1900.0, Unit::milliampere}}));
  EXPECT_EQ(pulls_of("150N", "--pulls"), (std::vector<BeltPull>{{150.0, Unit::newton}}));
  for (const char* wrong : {"", "1,", "1,150N", "0", "-1", "1x", "1e9"}) {
    EXPECT_THAT(refusal([&] { (void)pulls_of(wrong, "--pulls"); }),
                HasSubstr("one number for each run"))
        << wrong;
  }
}

TEST(Maslow4Session, VisitsAreNumberedOnAndEachRunHasItsPull) {
  const std::size_t count = twice().front().belts.points.size();
  const Maslow4Import session = one_session(twice(), pulls_of("1,1.6", "--pulls"));
  ASSERT_EQ(session.belts.points.size(), 2 * count);
  for (std::size_t k = 0; k < count; ++k) {
    const BeltPoint& first = session.belts.points[k];
    const BeltPoint& second = session.belts.points[k + count];
    EXPECT_GT(*second.order, *session.belts.points[count - 1].order);
    EXPECT_EQ(*second.order - *session.belts.points[count].order,
              *first.order - *session.belts.points.front().order);
    EXPECT_EQ(first.pull->value, 1.0);
    EXPECT_EQ(second.pull->value, 1.6);
  }
  EXPECT_EQ(different_pulls(session.belts), (std::vector<double>{1.0, 1.6}));
  EXPECT_FALSE(session.belts.firmware_fit);
}

TEST(Maslow4Session, TheLogSaysTheCurrentAndTheSettingsThatOfOneRun) {
  std::vector<Maslow4Import> runs = twice("$Maslow_Calibration_Current_Threshold=1300\n");
  EXPECT_EQ(runs.front().belts.points.back().pull,
            (BeltPull{1300.0, BeltPull::Unit::milliampere}));
  runs.back() = parse_maslow4("$/Maslow_Calibration_Current_Threshold=2080\n" + fixture(), "b.txt");
  EXPECT_EQ(different_pulls(one_session(std::move(runs), {}).belts),
            (std::vector<double>{1.0, 1.6}));
  Maslow4Options options;
  options.settings = "Maslow_Calibration_Current_Threshold: 1500\n";
  const Maslow4Import own = parse_maslow4(fixture(), "log.txt", options);
  EXPECT_EQ(one_session({own}, {}).belts.points.front().pull,
            (BeltPull{1500.0, BeltPull::Unit::milliampere}));
  // One file of settings does not say that two runs were pulled equally.
  EXPECT_THAT(refusal([&] { (void)one_session({own, own}, {}); }),
              HasSubstr("how hard belts were pulled in each run"));
}

TEST(Maslow4Session, WhatIsNoSessionIsRefused) {
  EXPECT_THAT(refusal([] { (void)one_session(twice(), {}); }),
              HasSubstr("no Maslow_Calibration_Current_Threshold"));
  EXPECT_THAT(refusal([] { (void)one_session(twice(), {BeltPull{}}); }),
              HasSubstr("a pull for each of the 2 runs"));
  std::vector<Maslow4Import> runs = twice();
  for (BeltPoint& point : runs.back().belts.points) {
    point.lengths_mm.bl += 300.0;
    point.lengths_mm.br += 300.0;
  }
  EXPECT_THAT(refusal([&] { (void)one_session(runs, pulls_of("1,1.6", "--pulls")); }),
              HasSubstr("runs of one frame"));
  EXPECT_THROW((void)one_session({}, {}), std::logic_error);
}

}  // namespace
}  // namespace chaintrue::grid::files::session
