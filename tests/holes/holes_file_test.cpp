// SPDX-License-Identifier: GPL-3.0-or-later
// Holes files: both formats have the same content, and every mistake is rejected with its message.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/files/holes_file.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::grid::files {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr const char* kCsv =
    "hole,x_mm,y_mm\n"
    "A,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\n"
    "# measured on Sunday\n"
    "from,to,distance_mm,sigma_mm\n"
    "A,B,1801.5,\nB,C,800.5,\nC,D,1799,0.7\nD,A,800,\nA,C,1970,\nB,D,1969.5,\nA,top,209,\n";

constexpr const char* kJson = R"({"file_type": "chaintrue_holes", "format_version": "1.0",
 "holes": [{"name": "A", "x_mm": -900, "y_mm": 400}, {"name": "B", "x_mm": 900, "y_mm": 400},
           {"name": "C", "x_mm": 900, "y_mm": -400}, {"name": "D", "x_mm": -900, "y_mm": -400}],
 "distances": [{"from": "A", "to": "B", "distance_mm": 1801.5}, {"from": 1, "to": 2, "distance_mm": 800.5},
   {"from": "C", "to": "D", "distance_mm": 1799, "sigma_mm": 0.7}, {"from": "D", "to": "A", "distance_mm": 800},
   {"from": 0, "to": "C", "distance_mm": 1970}, {"from": "B", "to": "D", "distance_mm": 1969.5},
   {"from": "A", "to": "top", "distance_mm": 209}]})";

std::vector<std::string> problems_of(const std::string& text, const HolesOptions& options = {}) {
  std::vector<std::string> messages;
  try {
    (void)parse_holes(text, "holes.csv", options);
  } catch (const InputError& error) {
    for (const InputProblem& problem : error.problems()) messages.push_back(problem.message());
  }
  return messages;
}

/// The distances of kCsv's holes with this table appended.
std::vector<std::string> problems_with(const std::string& distances) {
  return problems_of(
      "hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\nfrom,to,distance_mm\n" +
      distances);
}

constexpr const char* kSix = "A,B,1801\nB,C,800\nC,D,1799\nD,A,800\nA,C,1970\nB,D,1970\n";

TEST(HolesFile, CsvAndJsonSayTheSame) {
  const std::string from_csv = write_holes(parse_holes(kCsv, "holes.csv").holes);
  EXPECT_EQ(from_csv, write_holes(parse_holes(kJson, "holes.json").holes));
  EXPECT_EQ(from_csv, write_holes(parse_holes(from_csv, "again.json").holes));
}

TEST(HolesFile, KeepsAWholeSetWithItsMachine) {
  MeasuredHoles set = testing_support::nine_holes();
  set.tape.tape_zero_offset_mm = 40.0;
  set.tape.tape_zero_offset_sigma_mm = 0.5;
  for (HoleDistance& distance : set.distances) distance.distance_mm += 40.0;
  set.sheet.width_mm = 2440.0;
  const std::string text = write_holes(set);
  const ReadHoles read = parse_holes(text, "set.json");
  EXPECT_EQ(write_holes(read.holes), text);
  EXPECT_DOUBLE_EQ(read.holes.tape.tape_zero_offset_mm, 40.0);
  EXPECT_EQ(read.holes.tape.tape_zero_offset_sigma_mm, set.tape.tape_zero_offset_sigma_mm);
  EXPECT_EQ(read.holes.machine->motors.left.x_mm, set.machine->motors.left.x_mm);
}

TEST(HolesFile, OptionsStandInForWhatACsvCannotSay) {
  HolesOptions options;
  options.machine = testing_support::classic();
  options.tape_sigma_mm = 0.8;
  options.tape_zero_offset_mm = 0.0;
  options.hole_sigma_mm = 0.1;
  const MeasuredHoles set = parse_holes(kCsv, "holes.csv", options).holes;
  EXPECT_DOUBLE_EQ(sigma_of(set, set.distances[0]), 0.8);
  EXPECT_DOUBLE_EQ(sigma_of(set, set.distances[2]), 0.7) << "the reading's own sigma stands";
  EXPECT_DOUBLE_EQ(set.hole_sigma_mm, 0.1);
}

TEST(HolesFile, ADistanceToAHoleThatWasNotCutIsRefused) {
  EXPECT_THAT(
      problems_with(std::string(kSix) + "A,E,500\nF,B,500\nleft,B,300\nC,C,5\n"),
      ElementsAre(HasSubstr("line 13, column 3: found E, expected a hole that was cut (A, B, C, "
                            "D) or an edge of the sheet (left, right, top, bottom)"),
                  HasSubstr("line 14, column 1: found F, expected a hole that was cut: A, B, C, D"),
                  HasSubstr("found left, expected a hole that was cut"),
                  HasSubstr("found C, expected another hole than the distance starts at")));
}

TEST(HolesFile, ATriangleThatCannotCloseIsRefused) {
  EXPECT_THAT(problems_with("A,B,1801\nB,C,800\nC,D,1799\nD,A,800\nA,C,2970\nB,D,1970\n"),
              testing::Contains(AllOf(
                  HasSubstr("line 11, column 5: found 2970"),
                  HasSubstr("A-C cannot be longer than the way over A-B (1801) and B-C (800)"))));
}

TEST(HolesFile, ATriangleMayBeFlatWithinTheTapesError) {
  const std::string flat =
      "hole,x_mm,y_mm\nA,-900,400\nM,0,400\nB,900,400\nC,900,-400\nD,-900,-400\n"
      "from,to,distance_mm\nA,M,900\nM,B,900\nA,B,1801.5\nB,C,800\nC,D,1799\nD,A,800\n";
  EXPECT_THAT(problems_of(flat), IsEmpty());
}

TEST(HolesFile, CentimetresAreNotCalledInches) {
  EXPECT_THAT(problems_of("hole,x_mm,y_mm\nA,-90,40\nB,90,40\nC,90,-40\nD,-90,-40\n"
                          "from,to,distance_mm\n"
                          "A,B,180.1\nB,C,80.1\nC,D,179.9\nD,A,80.0\nA,C,197.0\nB,D,196.9\n"),
              ElementsAre(HasSubstr("these and their distances look like centimetres")));
  EXPECT_THAT(problems_with("A,B,180.1\nB,C,80.1\nC,D,179.9\nD,A,80.0\nA,C,197.0\nB,D,196.9\n"),
              ElementsAre(HasSubstr("the distances look like centimetres")));
}

TEST(HolesFile, InchesAreRecognised) {
  EXPECT_THAT(problems_with("A,B,70.9\nB,C,31.5\nC,D,70.8\nD,A,31.5\nA,C,77.5\nB,D,77.5\n"),
              ElementsAre(AllOf(HasSubstr("the distances look like inches"), HasSubstr("multiply the distances by 25.4"),
                                HasSubstr("half of the distances are over 1.7 m off what was commanded"))));
  EXPECT_THAT(problems_of("hole,x_mm,y_mm\nA,-35.4,15.7\nB,35.4,15.7\nC,35.4,-15.7\nD,-35.4,-15.7\n"
                          "from,to,distance_mm\n" +
                          std::string(kSix)),
              ElementsAre(HasSubstr("the holes' x_mm and y_mm look like inches")));
  EXPECT_THAT(problems_of("hole,x_mm,y_mm\nA,-35.4,15.7\nB,35.4,15.7\nC,35.4,-15.7\nD,-35.4,-15.7\n"
                          "from,to,distance_mm\n"
                          "A,B,70.9\nB,C,31.5\nC,D,70.8\nD,A,31.5\nA,C,77.5\nB,D,77.5\n"),
              ElementsAre(HasSubstr("these and their distances look like inches")));
}

TEST(HolesFile, AForgottenHookOffsetIsRefused) {
  const std::string long_by_40 =
      "hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\nfrom,to,distance_mm\n"
      "A,B,1841\nB,C,840\nC,D,1839\nD,A,840\nA,C,2010\nB,D,2010\n";
  try {
    (void)parse_holes(long_by_40, "holes.csv");
    FAIL() << "a map bent by 40 mm would have been made";
  } catch (const InputError& error) {
    ASSERT_EQ(error.problems().size(), 1u);
    EXPECT_THAT(error.problems()[0].message(),
                AllOf(HasSubstr("distances all about 40.1 mm longer than commanded"),
                      HasSubstr("the tape's hook offset"),
                      HasSubstr("the short ones are off like the long ones: give 40 mm")));
  }
  HolesOptions options;
  // A stated offset of zero is accepted, with a warning.
  options.tape_zero_offset_mm = 0.0;
  EXPECT_THAT(parse_holes(long_by_40, "holes.csv", options).warnings[0].message(),
              HasSubstr("give 40 mm"));
  options.tape_zero_offset_mm = 40.0;
  EXPECT_THAT(parse_holes(long_by_40, "holes.csv", options).warnings, IsEmpty());
  options.tape_zero_offset_mm = 80.0;
  EXPECT_THAT(parse_holes(long_by_40, "holes.csv", options).warnings[0].message(),
              HasSubstr("taken off twice"));
}

TEST(HolesFile, AScaleIsNoHookOffset) {
  // 2 % too long: 36 mm of the long ones, 16 mm of the short ones.
  EXPECT_THAT(parse_holes("hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\nD,-900,-400\n"
                          "from,to,distance_mm\n"
                          "A,B,1836\nB,C,816\nC,D,1836\nD,A,816\nA,C,2009\nB,D,2009\n",
                          "holes.csv")
                  .warnings,
              IsEmpty());
}

TEST(HolesFile, WhatIsMissingIsSaid) {
  EXPECT_THAT(
      problems_with("A,B,1801\nB,C,800\nA,C,1970\n"),
      ElementsAre(AllOf(HasSubstr("3 independent distances"),
                        HasSubstr("at least 5 independent distances between holes, one for "
                                  "each unknown: the motors' spacing, the zero and the scale "
                                  "of either chain"),
                        HasSubstr("2 missing, measure B-D, C-D"))));
  EXPECT_THAT(problems_of("hole,x_mm,y_mm\nA,-900,400\nB,900,400\nC,900,-400\n"
                          "from,to,distance_mm\nA,B,1801\nB,C,800\nA,C,1970\n"),
              ElementsAre(HasSubstr("cut at least 4 holes, of which 5 distances are independent")));
  // The same pair twice is redundant.
  EXPECT_THAT(problems_with("A,B,1801\nA,B,1801\nB,A,1801\nB,C,800\nB,C,800\nB,C,800\nA,C,1970\n"),
              ElementsAre(HasSubstr("3 independent distances")));
  HolesOptions check;
  check.fewest_distances = 1;
  EXPECT_THAT(
      problems_of("hole,x_mm,y_mm\nA,-900,400\nB,900,400\nfrom,to,distance_mm\nA,B,1801\n", check),
      IsEmpty());
}

TEST(HolesFile, NamesAreDistinctAndNoEdges) {
  EXPECT_THAT(
      problems_of("hole,x_mm,y_mm\nA,-900,400\nA,900,400\ntop,900,-400\nD,-900,-400\n"
                  "from,to,distance_mm\nA,D,800\n"),
      ElementsAre(HasSubstr("expected a name of its own for each hole; line 2, column 1 has "
                            "the same"),
                  HasSubstr("expected a name that is no edge of the sheet")));
}

TEST(HolesFile, AllProblemsAtOnceWithTheirPlaces) {
  EXPECT_THAT(problems_of(R"({"file_type": "chaintrue_holes", "format_version": "1.0", "tap": 1,
        "holes": [{"name": "A", "x_mm": "1", "y_mm": 0}, {"name": "B", "x_mm": 5}],
        "distances": [{"from": "A", "to": "B", "distance_mm": -3}, {"from": true, "to": "B", "distance_mm": 4}]})"),
              testing::IsSupersetOf({HasSubstr("/tap"),
                                     HasSubstr("/holes/0/x_mm"),
                                     HasSubstr("/holes/1/y_mm"),
                                     HasSubstr("/distances/0/distance_mm"),
                                     HasSubstr("/distances/1/from")}));
  EXPECT_THAT(problems_of("A,1,2\n"),
              ElementsAre(HasSubstr("a header line first: hole,x_mm,y_mm")));
  EXPECT_THAT(problems_of("hole,x_mm,y_mm\nA,1,2\n"), ElementsAre(HasSubstr("two tables")));
  EXPECT_THAT(problems_of("hole,x_mm\nA,1\nfrom,to,distance_mm\n"),
              testing::Contains(HasSubstr("the columns hole,x_mm,y_mm")));
}

}  // namespace
}  // namespace chaintrue::grid::files
