// SPDX-License-Identifier: GPL-3.0-or-later
// The output of a Maslow 4 as read: lists that grow, runs, commands, single readings, settings,
// roles.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/belts/belts_fit.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files {
namespace {

using model::Belt;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using ::testing::SizeIs;

std::string fixture(const std::string& name) {
  return read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / name);
}

Maslow4Options with_settings() {
  Maslow4Options options;
  options.settings = fixture("machines/maslow.yaml");
  return options;
}

TEST(Maslow4Log, WhatItSaysIsKept) {
  const Maslow4Import read = parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt");
  ASSERT_THAT(read.belts.points, SizeIs(31));
  // The list of six is the beginning of the list of 31.
  EXPECT_THAT(read.runs, SizeIs(1));
  const BeltPoint& first = read.belts.points[0];
  EXPECT_EQ(first.lengths_mm, (model::PerBelt<double>{1808.61, 1787.50, 1788.94, 1811.62}));
  for (std::size_t i = 0; i < 31; ++i) EXPECT_EQ(read.belts.points[i].order, static_cast<int>(i));
  ASSERT_TRUE(read.belts.points[8].commanded);
  EXPECT_EQ(read.belts.points[8].commanded->x_mm, -370.0);
  EXPECT_EQ(read.belts.points[8].commanded->y_mm, -200.0);
  EXPECT_THAT(read.belts.points[9].thrown_away_mm.br,
              ElementsAre(2124.562, 2124.279, 2127.188, 2124.523));
  EXPECT_THAT(read.belts.points[8].thrown_away_mm.br, IsEmpty());
  ASSERT_TRUE(read.belts.firmware_fit);
  EXPECT_EQ(read.belts.firmware_fit->rms_mm, 0.61);
  EXPECT_EQ(read.belts.firmware_fit->max_mm, 1.53);
}

TEST(Maslow4Log, WhatNeitherItNorTheSettingsSayIsAssumedAndSaid) {
  const Maslow4Import bare = parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt");
  EXPECT_FALSE(bare.belts.machine.anchors_known);
  EXPECT_THAT(bare.assumed,
              ElementsAre("heights of the anchors of tl 100, tr 56, bl 34, br 78 mm",
                          "an arm of 123.4 mm",
                          "an extension of the belt's end of 30 mm",
                          HasSubstr("stands upright"),
                          HasSubstr("since October 2024")));
  const Maslow4Import set =
      parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt", with_settings());
  EXPECT_THAT(set.assumed, ElementsAre(HasSubstr("since October 2024")));
  const model::BeltMachine& machine = set.belts.machine;
  EXPECT_TRUE(machine.anchors_known);
  EXPECT_EQ(machine.anchors.tr.x_mm, 2924.3);
  EXPECT_EQ(machine.anchors.br.x_mm, 2953.2);
  EXPECT_EQ(machine.surface_mm, 18.0);
  Maslow4Options answer = with_settings();
  answer.lengths = model::BeltLengths::belt_and_arm;
  const Maslow4Import old = parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt", answer);
  EXPECT_THAT(old.assumed, IsEmpty());
  EXPECT_EQ(old.belts.machine.lengths, model::BeltLengths::belt_and_arm);
}

TEST(Maslow4Log, SettingsOf2024StandAtTheRoot) {
  Maslow4Options options;
  options.settings =
      "Maslow_vertical: false\nMaslow_tlX: -12.5\nMaslow_tlY: 2050\nMaslow_trX: 2900\nMaslow_trY: "
      "2040\nMaslow_brX: 2910\nMaslow_armLength: 120\n";
  const Maslow4Import read = parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt", options);
  EXPECT_TRUE(read.belts.machine.anchors_known);
  EXPECT_EQ(read.belts.machine.anchors.tl.x_mm, -12.5);
  EXPECT_EQ(read.belts.machine.arm_mm, 120.0);
  EXPECT_EQ(read.belts.machine.orientation, model::Orientation::flat);
}

TEST(Maslow4Log, OnAFlatFrameTheBeltsBehindTheMoveArePulled) {
  Maslow4Options options = with_settings();
  options.orientation = model::Orientation::flat;
  const Maslow4Import read = parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt", options);
  const auto pulled = [&](std::size_t i) { return *read.belts.points[i].pulled; };
  // At the first six the upper belts hold, whatever the direction of approach.
  EXPECT_THAT(pulled(1), ElementsAre(Belt::bl, Belt::br));
  EXPECT_THAT(pulled(7), ElementsAre(Belt::tl, Belt::tr));   // down
  EXPECT_THAT(pulled(8), ElementsAre(Belt::tr, Belt::br));   // to the left
  EXPECT_THAT(pulled(9), ElementsAre(Belt::bl, Belt::br));   // up
  EXPECT_THAT(pulled(11), ElementsAre(Belt::tl, Belt::bl));  // to the right
}

TEST(Maslow4Log, SeveralRunsAreToldApart) {
  const std::string text = fixture("good/maslow4_notes.txt");
  const Maslow4Import last = parse_maslow4(text, "notes.txt");
  ASSERT_THAT(last.runs, SizeIs(2));
  EXPECT_EQ(last.runs[0].heading, "Run 1:");
  EXPECT_EQ(last.runs[1].heading, "run two");
  EXPECT_EQ(last.runs[0].points.last, 5U);
  EXPECT_EQ(last.runs[1].points.first, 6U);
  EXPECT_EQ(last.taken, 1U);
  EXPECT_THAT(last.belts.points, SizeIs(9));
  EXPECT_THAT(last.assumed, Contains(HasSubstr("looks older than October 2024")));
  Maslow4Options options;
  options.part = 1;
  EXPECT_THAT(parse_maslow4(text, "notes.txt", options).belts.points, SizeIs(6));
  options.part = 3;
  EXPECT_THROW((void)parse_maslow4(text, "notes.txt", options), InputError);
  Maslow4Options range;
  range.part = log_parts_of("7:14", "--runs").front();
  const Maslow4Import part = parse_maslow4(text, "notes.txt", range);
  EXPECT_EQ(part.taken, 1U);
  EXPECT_THAT(part.belts.points, SizeIs(8));
  EXPECT_EQ(part.belts.points[0].lengths_mm, last.belts.points[1].lengths_mm);
  range.part = PointRange{3, 40};
  EXPECT_THROW((void)parse_maslow4(text, "notes.txt", range), InputError);
  EXPECT_EQ(std::get<int>(*log_parts_of("1,2", "--runs")[1]), 2);
  for (const char* wrong : {"", "0", "1,", "1.5", "7:", ":7", "9:3", "-1:4", "1.5:4", "a:b", "1:2:3"})
    EXPECT_THROW((void)log_parts_of(wrong, "--runs"), InputError) << wrong;
}

TEST(Maslow4Log, ListsOfOneGoOnAndAnotherListIsAnotherRun) {
  const std::string text = fixture("good/maslow4_log.txt");
  const std::size_t begin = text.rfind("CLBM:[") + 6;
  std::vector<std::string> readings;
  for (std::size_t at = begin; at < text.size() && text[at] == '{';) {
    const std::size_t end = text.find('}', at) + 1;
    readings.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  ASSERT_THAT(readings, SizeIs(31));
  const auto listed = [&](std::size_t first, std::size_t last) {
    std::string list = "[MSG:INFO: CLBM:[";
    for (std::size_t i = first; i < last; ++i) list += readings[i] + ",";
    return list + "]]\n";
  };
  // Six at once, as the browser of 2025 received them, then one by one, one of them sent twice.
  std::string single = listed(0, 6);
  for (std::size_t i = 6; i < 31; ++i) single += listed(i, i + 1);
  single += listed(30, 31);
  const Maslow4Import one = parse_maslow4(single, "log.txt");
  EXPECT_THAT(one.runs, SizeIs(1));
  EXPECT_THAT(one.belts.points, SizeIs(31));
  const Maslow4Import two = parse_maslow4(listed(0, 15) + listed(15, 31), "log.txt");
  EXPECT_THAT(two.runs, SizeIs(2));
  EXPECT_THAT(two.belts.points, SizeIs(16));
  // Waypoints printed again after the first six belong to the same run.
  const std::string anew = "Waypoints [0-1]: (0:0.0,0.0) (1:150.0,0.0)\n" + listed(0, 6) +
                           "Waypoints [0-1]: (0:1.0,2.0) (1:151.0,2.0)\n" + listed(0, 31);
  const Maslow4Import goes_on = parse_maslow4(anew, "log.txt");
  EXPECT_THAT(goes_on.runs, SizeIs(1));
  EXPECT_EQ(goes_on.belts.points[1].commanded->x_mm, 151.0);
}

TEST(Maslow4Log, BadSettingsAreReportedWithTheirFile) {
  Maslow4Options options;
  options.settings = "Maslow_vertical: perhaps\nMaslow_armLength: long\nMaslow_tlX: 80\n";
  options.settings_file = "mine.yaml";
  try {
    (void)parse_maslow4(fixture("good/maslow4_log.txt"), "log.txt", options);
    FAIL() << "read";
  } catch (const InputError& error) {
    std::vector<std::string> messages;
    for (const InputProblem& problem : error.problems()) messages.push_back(problem.message());
    EXPECT_THAT(messages, Contains(HasSubstr("mine.yaml: Maslow_vertical: found perhaps")));
    EXPECT_THAT(messages, Contains(HasSubstr("mine.yaml: line 2: found long")));
  }
}

}  // namespace
}  // namespace chaintrue::grid::files
