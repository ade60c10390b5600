// SPDX-License-Identifier: GPL-3.0-or-later
// Logs as owners paste them: cut, torn, copied twice, of runs that failed. What is there is taken, what is
// damaged is left out with its line, and a failed run gets an answer.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "grid/belts/belts_fit.hpp"
#include "grid/files/maslow4_log.hpp"
#include "grid/files/whole_file.hpp"

namespace chaintrue::grid::files::damaged_logs {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::SizeIs;

std::string fixture(const std::string& name) {
  return read_whole_file(std::filesystem::path(CHAINTRUE_FIXTURES) / name);
}

std::string log_text() { return fixture("good/maslow4_log.txt"); }

Maslow4Options with_settings() {
  Maslow4Options options;
  options.settings = fixture("machines/maslow.yaml");
  return options;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.rfind(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::vector<std::string> said(const Maslow4Import& read) {
  std::vector<std::string> messages;
  for (const Warning& warning : read.warnings) messages.push_back(warning.message());
  return messages;
}

/// The list of 31 alone, without waypoints and without the shorter list before it.
std::string last_list() {
  const std::string text = log_text();
  const std::size_t begin = text.rfind("CLBM:[");
  return text.substr(begin, text.find('\n', begin) - begin + 1);
}

TEST(DamagedLog, OneDamagedReadingIsLeftOutWithItsLine) {
  for (const char* damage :
       {"tr1370.56", "tr:13x0.56", "tr:-1370.56", "tx:1370.56", "tl:1370.56"}) {
    SCOPED_TRACE(damage);
    const Maslow4Import read =
        parse_maslow4(replaced(last_list(), "tr:1370.56", damage), "log.txt");
    EXPECT_THAT(read.belts.points, SizeIs(30));
    EXPECT_THAT(said(read),
                Contains(AllOf(HasSubstr("log.txt: line 1, column"),
                               HasSubstr("this reading is left out: found"))));
    // The visit keeps its number: what sets in during a session goes by it.
    EXPECT_EQ(read.belts.points[11].order, 11);
    EXPECT_EQ(read.belts.points[12].order, 13);
    EXPECT_TRUE(read.is_enough);
  }
}

TEST(DamagedLog, WhatOnePrintOfAListLostTheOtherHas) {
  // The first six are printed twice.
  const Maslow4Import read =
      parse_maslow4(replaced(log_text(), "tr:1578.24", "tr1578.24"), "log.txt");
  EXPECT_THAT(read.runs, SizeIs(1));
  ASSERT_THAT(read.belts.points, SizeIs(31));
  EXPECT_EQ(read.belts.points[2].lengths_mm.tr, 1578.24);
  EXPECT_THAT(said(read), ::testing::ElementsAre(HasSubstr("line 1: ignored")));
  ASSERT_TRUE(read.belts.points[8].commanded);
}

TEST(DamagedLog, LinesBrokenInTwoColoursAndOtherOutputAreReadOver) {
  const Maslow4Import whole = parse_maslow4(log_text(), "log.txt");
  std::string text = replaced(log_text(), "br:1442.55", "br:14\n42.55");
  text = replaced(text, "tl:2227.96", "\n[MSG:INFO: Sled at rest]\nok\ntl:2227.96");
  text = replaced(text, "(14:370.0,-200.0)", "(14:37\n0.0,-200.0)");
  text = replaced(text, "Measured waypoint 12]", "Measured way\npoint 12]");
  std::string coloured;
  for (const char c : text) {
    if (c == '\n') coloured += "\x1b[0m\r";
    coloured += c;
    if (c == '\n') coloured += "\x1b[0;32m";
  }
  for (const std::string& damaged : {text, coloured}) {
    const Maslow4Import read = parse_maslow4(damaged, "log.txt");
    ASSERT_THAT(read.belts.points, SizeIs(31));
    for (std::size_t i = 0; i < 31; ++i) {
      EXPECT_EQ(read.belts.points[i].lengths_mm, whole.belts.points[i].lengths_mm) << i;
      ASSERT_TRUE(read.belts.points[i].commanded) << i;
      EXPECT_EQ(read.belts.points[i].commanded->x_mm, whole.belts.points[i].commanded->x_mm) << i;
    }
    EXPECT_EQ(read.belts.points[9].thrown_away_mm, whole.belts.points[9].thrown_away_mm);
  }
}

TEST(DamagedLog, AListWithoutAnEndGivesWhatIsBefore) {
  const std::string list = last_list();
  const Maslow4Import read = parse_maslow4(list.substr(0, list.find("tr:1602.41") + 12), "log.txt");
  EXPECT_THAT(read.belts.points, SizeIs(30));
  EXPECT_THAT(said(read), Contains(HasSubstr("the log ends in the middle of a list")));
}

TEST(DamagedLog, ReadingsLostWithoutATraceLeaveTheCommandsOut) {
  std::string text = log_text();
  const std::size_t begin = text.rfind("{bl:2205.89");
  text.erase(begin, text.find('}', begin) + 2 - begin);
  const Maslow4Import read = parse_maslow4(text, "log.txt");
  EXPECT_THAT(read.belts.points, SizeIs(30));
  for (const BeltPoint& point : read.belts.points) EXPECT_FALSE(point.commanded);
  EXPECT_THAT(said(read), Contains(HasSubstr("where the machine was sent is left out")));
}

TEST(DamagedLog, TwoFramesInOnePasteAreTwoRuns) {
  const std::string list = last_list();
  std::string text;
  for (std::size_t at = list.find('{'); at != std::string::npos; at = list.find('{', at + 1))
    text += list.substr(at, list.find('}', at) + 1 - at) + "\n";
  // The frame of the other fixture, at seven tenths.
  for (const BeltPoint& point :
       parse_maslow4(fixture("good/maslow4_notes.txt"), "notes.txt").belts.points) {
    const auto& l = point.lengths_mm;
    text += fmt::format("{{bl:{:.2f}, br:{:.2f}, tr:{:.2f}, tl:{:.2f}}}\n",
                        0.7 * l.bl,
                        0.7 * l.br,
                        0.7 * l.tr,
                        0.7 * l.tl);
  }
  const Maslow4Import read = parse_maslow4(text, "log.txt");
  ASSERT_THAT(read.runs, SizeIs(2));
  EXPECT_EQ(read.runs[0].points.last, 30U);
  EXPECT_THAT(read.belts.points, SizeIs(9));
  EXPECT_THAT(said(read), Contains(AllOf(HasSubstr("line 32"), HasSubstr("of another frame"))));
}

/// A run that stops before its list: single readings, as the firmware prints them when they disagree.
std::string run_that_stops(const std::string& end) {
  const std::string text = log_text();
  std::string log = text.substr(0, text.find("[MSG:INFO: Measured waypoint 0]"));
  const Maslow4Import whole = parse_maslow4(text, "log.txt");
  for (int waypoint = 0; waypoint < 7; ++waypoint) {
    log +=
        "[MSG:ERR: Measurement error, measurements are not within 2.5 mm of each other, trying "
        "again]\n";
    for (const auto& [label, belt] : {std::pair{"Top Left", model::Belt::tl},
                                      std::pair{"Top Right", model::Belt::tr},
                                      std::pair{"Bottom Left", model::Belt::bl},
                                      std::pair{"Bottom Right", model::Belt::br}}) {
      for (const double off : {0.0, 0.1, -0.1, 2.9}) {
        log += fmt::format(
            "[MSG:INFO: {} {:.3f}]\n",
            label,
            whole.belts.points[static_cast<std::size_t>(waypoint)].lengths_mm[belt] + off);
      }
    }
    if (waypoint < 6) log += fmt::format("[MSG:INFO: Measured waypoint {}]\n", waypoint);
  }
  return log + end;
}

TEST(FailedRun, PlacesAreMadeOfSingleReadings) {
  const Maslow4Import read = parse_maslow4(run_that_stops(""), "log.txt");
  ASSERT_THAT(read.belts.points, SizeIs(6));
  // Medians of four that lie a tenth on either side.
  EXPECT_NEAR(read.belts.points[0].lengths_mm.tl, 1808.61, 0.051);
  EXPECT_THAT(said(read), Contains(HasSubstr("made of single readings")));
}

TEST(FailedRun, GetsAnAnswerOfItsOwn) {
  const std::string critical =
      "[MSG:ERR: Critical error, measurements are not within 1.5mm of each other 8 times in a row, "
      "stopping Find Anchors]\n";
  const auto answer = [&](const std::string& singles) {
    return parse_maslow4(run_that_stops(singles + critical), "log.txt").stopped.value_or("");
  };
  const std::string again =
      "[MSG:ERR: Measurement error, measurements are not within 2.5 mm of each other, trying "
      "again]\n";
  const std::string agreeing =
      "[MSG:INFO: Top Left 1812.1]\n[MSG:INFO: Top Left 1812.2]\n[MSG:INFO: Bottom Left 1785.1]\n"
      "[MSG:INFO: Bottom Left 1785.2]\n";
  EXPECT_THAT(
      answer(again + agreeing + "[MSG:INFO: Top Right 1790.1]\n[MSG:INFO: Top Right 1803.4]\n"),
      AllOf(HasSubstr("after waypoint 5 of 0 to 30"),
            HasSubstr("the readings of the top right belt lie 13.3 mm apart"),
            HasSubstr("a slack belt"),
            HasSubstr("diagnose weighs the causes")));
  EXPECT_THAT(
      answer(again + agreeing + "[MSG:INFO: Top Right 1790.1]\n[MSG:INFO: Top Right 1834.2]\n"),
      AllOf(HasSubstr("a whole turn of its encoder"), HasSubstr("lost turns")));
}

TEST(FailedRun, WithoutAnyReadingsIsRefusedWithItsAnswer) {
  const std::string start = log_text().substr(0, log_text().find("[MSG:INFO: Measured"));
  const struct {
    const char* message;
    const char* answer;
  } kRuns[] = {
      {"[MSG:ERR: Find Anchors fit failed: per-anchor RMS imbalance: max=0.581mm (anchor 1) > "
       "2.000x "
       "min=0.277mm]",
       "do that by chance"},
      {"[MSG:ERR: Find Anchors fit failed: LM did not converge (rejections=11 lambda=1.000)]",
       "solver stalled"},
      {"Calibration stopped due to low fitness after maximum retries.",
       "belts at the wrong anchors"},
      {"[MSG:ERR: Center point deviation over 12.000mm, your coordinate system is not accurate, "
       "maybe try "
       "running calibration again?]",
       "settings of another frame"},
      {"[MSG:INFO: Requesting state change from Finding Anchor to Belts Extended]",
       "without a word"}};
  for (const auto& run : kRuns) {
    try {
      (void)parse_maslow4(start + run.message + "\n", "log.txt");
      ADD_FAILURE() << "read: " << run.message;
    } catch (const InputError& error) {
      ASSERT_THAT(error.problems(), SizeIs(1));
      EXPECT_THAT(error.problems()[0].message(),
                  AllOf(HasSubstr("log.txt: line 3"),
                        HasSubstr("did not come to its end"),
                        HasSubstr(run.answer)));
    }
  }
}

TEST(FailedRun, BeltsAtTheWrongAnchorsAreSeenAtTheFirstPlaces) {
  std::string text = run_that_stops("");
  text = text.substr(0, text.find("[MSG:INFO: Measured waypoint 3]"));
  const auto exchanged = [](std::string log, const std::string& a, const std::string& b) {
    for (const auto& [from, to] : {std::pair{a, std::string("@")}, {b, a}, {std::string("@"), b}}) {
      for (std::size_t at = log.find(from); at != std::string::npos; at = log.find(from, at))
        log.replace(at, from.size(), to);
    }
    return log;
  };
  const auto answer = [](const std::string& log) {
    const std::string stop =
        "[MSG:ERR: Find Anchors fit failed: LM did not converge (rejections=11 lambda=1.000)]\n";
    return parse_maslow4(log + stop, "log.txt", with_settings()).stopped.value_or("");
  };
  EXPECT_THAT(answer(text),
              AllOf(HasSubstr("after waypoint 2"), ::testing::Not(HasSubstr("swapped"))));
  EXPECT_THAT(
      answer(exchanged(exchanged(text, "Top Left", "Top Right"), "Bottom Left", "Bottom Right")),
      HasSubstr("tl and tr swapped and bl and br as well"));
  // A belt that lost a turn of its encoder, at all places.
  std::string turned;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find("Top Right ");
    turned += at == std::string::npos ? line
                                      : fmt::format("[MSG:INFO: Top Right {:.3f}]",
                                                    std::stod(line.substr(at + 10)) + 43.975);
    turned += '\n';
  }
  EXPECT_THAT(
      answer(turned),
      AllOf(HasSubstr("The top right belt reads"), HasSubstr("a whole turn of its encoder")));
}

TEST(DamagedLog, SettingsThatNoMachineHasAreRefusedWithTheirName) {
  Maslow4Options options;
  options.settings = replaced(fixture("machines/maslow.yaml"), "Maslow_Scale_X: 1.0", "Maslow_Scale_X: -1");
  try {
    (void)parse_maslow4(log_text(), "log.txt", options);
    FAIL() << "it was taken";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the settings' /scale_x: found -1"));
  }
}

}  // namespace
}  // namespace chaintrue::grid::files::damaged_logs
