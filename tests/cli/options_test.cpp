// SPDX-License-Identifier: GPL-3.0-or-later
// Numeric options follow the rules of numbers in files; every value is either accepted or rejected
// with a message and exit code 3.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/cli/command_fixture.hpp"

namespace chaintrue {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing_support::content_of;
using testing_support::Outcome;

class Options : public testing_support::CommandFixture {
 protected:
  void expect_refused(const std::string& arguments, const std::string& words) const {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr(words));
    EXPECT_EQ(outcome.out, "");
  }
  /// Runs every verb that reads changed.json, and `check`.
  void expect_changed_is_refused(const std::string& check) const {
    write("b.nc", "G21 G90\nG0 X0 Y0\nM2\n");
    expect_refused("query changed.json 0 0", kHashFound);
    expect_refused("report changed.json -o r.html", kHashFound);
    expect_refused("gcode compensate b.nc --map changed.json -o t.nc", kHashFound);
    expect_refused(check, kHashFound);
  }
  static constexpr const char* kHashFound = "/content_hash: found";
  static std::string fixture(const std::string& name) {
    return std::string(CHAINTRUE_FIXTURES) + "/" + name;
  }
  const std::string grid_ = fixture("grids/seven_by_four.json");
};

TEST_F(Options, AreHeldToTheRangesOfFiles) {
  const std::string fit = "fit " + grid_ + " -o m.json ";
  const std::string dof = "command line: --noise-dof: found ";
  expect_refused(fit + "--noise-dof 0", dof + "0, expected a number from 1 to 1000000000");
  expect_refused(fit + "--noise-dof -1", dof + "-1, expected a number from 1 to");
  expect_refused(fit + "--noise-dof nan", dof + "nan, expected a number from 1 to");
  const std::string length = "command line: --noise-length-mm: found ";
  for (const char* value : {"-1", "nan", "inf", "1e300", "1e999", "abc", "0x10"}) {
    expect_refused(fit + "--noise-length-mm " + value,
                   length + value + ", expected a number in mm from 0 to 100");
  }
  expect_refused(fit + "--noise-length-mm 0,2", "with a decimal point");
  expect_refused("gcode check b.nc --step-budget -1",
                 "command line: --step-budget: found -1, expected a whole number from 1 to");
  expect_refused("gcode check b.nc --step-budget 1.5", "a whole number");
  EXPECT_FALSE(exists("m.json"));
}

TEST_F(Options, ThatAreWrongAreAllNamedAtOnce) {
  const Outcome outcome = run("fit " + grid_ + " -o m.json --noise-dof 0 --noise-length-mm nan");
  EXPECT_EQ(outcome.code, 3);
  EXPECT_THAT(outcome.err, HasSubstr("--noise-dof"));
  EXPECT_THAT(outcome.err, HasSubstr("--noise-length-mm"));
}

/// Numbers out of range, a verb's own choices, and places in files.
TEST_F(Options, OfAllKindsAreToldAtOnce) {
  const auto expect_all = [this](const std::string& arguments,
                                 const std::vector<std::string>& words) {
    SCOPED_TRACE(arguments);
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(outcome.out, "");
    for (const std::string& word : words) EXPECT_THAT(outcome.err, HasSubstr(word));
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'),
              static_cast<std::ptrdiff_t>(words.size()));
  };
  const std::string machine = fixture("machines/classic.json");
  expect_all("simulate --machine " + machine +
                 " --grid 7by4 --repeats -1 --order sideways --model rubber --offset x=1 "
                 "--effect sag -o nowhere/g.json",
             {"--repeats: found -1",
              "--grid: found 7by4",
              "--order: found sideways",
              "--model: found rubber",
              "--offset: found x=1",
              "--effect: found sag",
              "nowhere/g.json: found a folder that does not exist"});
  // A number out of range does not hide problems of other options.
  expect_all("simulate --machine " + machine + " --holes 99 -o h.json", {"--holes: found 99"});
  expect_all("effects no_such_effect --machine " + machine + " --length-noise-mm 0 --set a",
             {"--length-noise-mm: found 0", "--set: found a", "effect: found no_such_effect"});
  expect_all("effects chain_stretch --side up --machine " + machine + " --position-noise-mm -1",
             {"--position-noise-mm: found -1", "--side: found up"});
  expect_all("sweep " + fixture("sweeps/quick.json") + " -o '' --shard 4/3 --threads -1",
             {"--threads: found -1", "--shard: found 4/3", "-o: found an empty name"});
  ASSERT_EQ(run("fit " + grid_ + " -o m.json").code, 0);
  write("b.nc", "G21 G90\nG0 X0 Y0\nM2\n");
  expect_all(
      "gcode compensate b.nc --map m.json -o b.nc --tolerance-mm 0.0005 --step-budget 0 "
      "--home 1",
      {"--step-budget: found 0",
       "--tolerance-mm: found 0.0005",
       "--home: found 1",
       "b.nc: found a file that is read here"});
}

TEST_F(Options, OfACheckAreNumbersToo) {
  ASSERT_EQ(run("fit " + grid_ + " -o m.json").code, 0);
  expect_refused("check m.json " + fixture("grids/five_new_points.json") + " --noise-length-mm nan",
                 "--noise-length-mm: found nan");
}

TEST_F(Options, OfACompensationLeaveRoomForRounding) {
  ASSERT_EQ(run("fit " + grid_ + " -o m.json").code, 0);
  write("b.nc", "G21 G90\nG0 X0 Y0\nG1 X300 Y100 F500\nM2\n");
  const std::string compensate = "gcode compensate b.nc --map m.json -o t.nc --tolerance-mm 0.0005";
  // Rounding to three decimals takes sqrt(3) / 2 of 0.001 mm.
  expect_refused(compensate, "--tolerance-mm: found 0.0005, expected more than 0.001 mm");
  EXPECT_EQ(run(compensate + " --decimals 4").code, 0);
}

TEST_F(Options, OfLengthsAskForATableThatCanBe) {
  ASSERT_EQ(run("fit " + grid_ + " -o m.json").code, 0);
  write("b.nc", "G21 G90\nG0 X0 Y0\nG1 X300 Y400 F500\nM2\n");
  expect_refused("gcode lengths b.nc --map m.json --every-mm 1e-9",
                 "--every-mm: found 1e-09, expected at least 2.5e-05 mm: 0.5 m of path would make "
                 "5.0e+11 rows, about 50000 GB");
}

TEST_F(Options, OfAMachineOfLittleMoreThanSprocketsGiveATableOfNumbers) {
  const Outcome outcome =
      run("effects chain_pitch_error --machine " + fixture("machines/t1_wrap_only.json"));
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, Not(HasSubstr("nan")));
  EXPECT_THAT(outcome.out, HasSubstr("chain_pitch_error"));
}

TEST_F(Options, OfAFarMotorGiveNoTableOfNothing) {
  std::string machine = content_of(fixture("machines/classic.json"));
  const std::size_t left = machine.find("-1489.2");
  ASSERT_NE(left, std::string::npos);
  for (const char* x_mm : {"10", "-90000", "-1200"}) {
    std::string far = machine;
    far.replace(left, 7, x_mm);
    write("far.json", far);
    for (const char* effect : {"chain_pitch_error", "chain_stretch"}) {
      SCOPED_TRACE(std::string(effect) + " with the left motor at x = " + x_mm);
      const Outcome outcome = run(std::string("effects ") + effect + " --machine far.json");
      EXPECT_TRUE(outcome.code == 0 || outcome.code == 3 || outcome.code == 4) << outcome.code;
      EXPECT_THAT(outcome.out, Not(HasSubstr("nan")));
      EXPECT_THAT(outcome.err, Not(HasSubstr("internal error")));
      if (outcome.code != 0) {
        EXPECT_THAT(outcome.err,
                    testing::AnyOf(HasSubstr("left motor"), HasSubstr("/motors/left")));
      }
    }
  }
}

TEST_F(Options, WhatAMachineDoesNotSayIsToldByEveryVerbOnce) {
  const std::string machine = content_of(fixture("machines/classic.json"));
  const std::size_t at = machine.find("\"uncertainty\"");
  ASSERT_NE(at, std::string::npos);
  std::string silent = machine;
  silent.replace(at, machine.find('}', at) + 1 - at, "\"comment\": {}");
  write("m.json", silent);
  write("b.nc", "G21 G90\nG0 X0 Y0\nG1 X300 Y100 F500\nM2\n");
  ASSERT_EQ(run("fit " + grid_ + " -o map.json").code, 0);
  for (const std::string& verb : {
           std::string("square --machine m.json --controller-machine m.json --at 0 0"),
           std::string("export groundcontrol m.json"),
           std::string("effects chain_stretch --machine m.json"),
           std::string("gcode check b.nc --machine m.json"),
           std::string("gcode check b.nc --map map.json --machine m.json"),
           "fit " + grid_ + " --with " + grid_ + " --machine m.json -o fitted.json",
           std::string("plan --machine m.json"),
           std::string("simulate --machine m.json --grid 7x4"),
       }) {
    SCOPED_TRACE(verb);
    const Outcome outcome = run(verb);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::string words = "m.json: /uncertainty: not given; assumed are motor positions";
    const std::size_t first = outcome.err.find(words);
    EXPECT_NE(first, std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find(words, first + 1), std::string::npos) << "told twice";
  }
}

TEST_F(Options, TwoByteOrderMarksBeforeACommentAreNoReasonToFall) {
  write("points.csv", "\xEF\xBB\xBF\xEF\xBB\xBF# x\n");
  for (const char* verb : {"fit points.csv -o m.json", "diagnose points.csv"}) {
    const Outcome outcome = run(verb);
    EXPECT_EQ(outcome.code, 3) << verb;
    EXPECT_THAT(outcome.err, HasSubstr("found only blank lines and comments"));
  }
  write("one.csv", "\xEF\xBB\xBF# only one\nx_mm,y_mm,left_mm,right_mm\n");
  EXPECT_THAT(run("fit one.csv -o m.json").err, HasSubstr("found a header line only"));
}

/// The same file with one digit changed, the first after `place`.
std::string with_another_digit(std::string text, const std::string& place) {
  const std::size_t digit = text.find_first_of("123456789", text.find(place));
  EXPECT_NE(digit, std::string::npos) << place;
  text.at(digit) = text.at(digit) == '1' ? '2' : '1';
  return text;
}

TEST_F(Options, AMapThatWasChangedIsRefused) {
  ASSERT_EQ(run("fit " + grid_ + " -o m.json").code, 0);
  const std::string text = content_of(folder_ / "m.json");
  write("changed.json", with_another_digit(text, "\"coefficients_left_mm\""));
  expect_changed_is_refused("check changed.json " + fixture("grids/five_new_points.json"));
  // Comments and layout are not part of the content.
  std::string commented = text;
  commented.insert(commented.find("\"name\""), "\"comment\": \"the shop's\",\n");
  write("commented.json", commented);
  EXPECT_EQ(run("query commented.json 0 0").out, run("query m.json 0 0").out);
}

TEST_F(Options, AnchorsThatWereChangedAreRefused) {
  const std::string belts = fixture("belts/thirty_one_places.json");
  ASSERT_EQ(run("fit " + belts + " -o a.json").code, 0);
  write("changed.json", with_another_digit(content_of(folder_ / "a.json"), "\"tr\""));
  expect_changed_is_refused("check changed.json " + belts);
  expect_refused("export maslow4 changed.json", kHashFound);
  expect_refused("simulate --belts changed.json --grid 3x3 -o s.json", kHashFound);
}

TEST_F(Options, AMapWithoutAHashIsRefused) {
  ASSERT_EQ(run("fit " + grid_ + " -o m.json").code, 0);
  std::string map = content_of(folder_ / "m.json");
  const std::size_t hash = map.rfind(",\n  \"content_hash\"");
  map.erase(hash, map.rfind('\n', map.size() - 2) - hash);
  write("changed.json", map);
  expect_refused("query changed.json 0 0",
                 "/content_hash: missing, expected the hash of this file's content");
}

}  // namespace
}  // namespace chaintrue
