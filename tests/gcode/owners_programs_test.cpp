// SPDX-License-Identifier: GPL-3.0-or-later
// Programs as CAM programs, plotters and mail programs leave them: each kind has a law.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"
#include "tools/gcode/path.hpp"
#include "tools/gcode/reports.hpp"

namespace chaintrue::gcode {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const Sheet kUsualSheet{{-1219.2, 1219.2, -609.6, 609.6}, true};

/// What check says: problems in their order, then notes.
struct Checked {
  std::vector<std::string> problems;  ///< "bad_arc 4"
  std::vector<std::string> notes;
  std::string words;  ///< every sentence
  std::optional<Survey> survey;

  [[nodiscard]] bool succeeds() const { return problems.empty(); }
};

Checked check(const std::string& program, Dialect dialect = {.passes_plotter_codes = true}) {
  auto source = LineSource::from_text(program);
  Findings findings;
  const auto found = survey(source, dialect, kUsualSheet, findings);
  Checked result;
  if (found) result.survey = *found;
  if (!found) findings.problems.push_back(found.error());
  for (const Problem& problem : findings.problems) {
    result.problems.push_back(fmt::format("{} {}", name(problem.name), problem.place.line));
    result.words += problem.message() + "\n";
  }
  for (const Note& note : findings.notes) {
    result.notes.emplace_back(note.name);
    result.words += note.sentence + "\n";
  }
  return result;
}

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(FreeCad, ZeroAcrossThePlaneChangesNoArc) {
  struct Plane {
    const char* arc;
    const char* across;
  };
  for (const auto& [arc, across] : {Plane{"G17 G2 X10 I5 J0", "K"}, Plane{"G18 G3 X10 Z2 I5 K1", "J"},
                                    Plane{"G19 G2 Y10 J5 K0", "I"}, Plane{"G17 G3 X8 Y3 R9", "K"},
                                    Plane{"G90.1 G17 G2 X10 I5 J0", "K"}}) {
    ProgramEvents without, with, other;
    const std::string begin = "G21 G90 F100 G0 X0 Y0 Z0\n" + std::string(arc);
    ASSERT_TRUE(run_text(begin, without)) << arc;
    ASSERT_TRUE(run_text(begin + " " + across + "0.000", with)) << arc;
    const Arc& a = *without.moves.back().arc;
    const Arc& b = *with.moves.back().arc;
    EXPECT_EQ(a.centre, b.centre);
    EXPECT_EQ(a.sweep_rad, b.sweep_rad);
    const auto refused = run_text(begin + " " + across + "0.001", other);
    ASSERT_FALSE(refused) << arc;
    EXPECT_EQ(refused.error().name, ProblemName::bad_arc);
  }
}

TEST(OperatorsText, IsPassedByAPlotterAndAMessageElsewhere) {
  for (const char* line : {"M0 Put Pen In", "m00 END - Lid On", "M1 Don't touch (yet) ; blue", "M0 Größe 3"}) {
    ProgramEvents plotter, router;
    ASSERT_TRUE(run_text(std::string(line) + "\n", plotter, {.passes_plotter_codes = true})) << line;
    ASSERT_TRUE(run_text(std::string(line) + "\n", router)) << line;
    const std::string text = plotter.words.at(0).text;
    EXPECT_THAT(text, testing::StartsWith("M"));
    const std::string code = router.words.at(0).text;
    EXPECT_EQ(text, code + " " + router.comments.at(0).text);
    EXPECT_TRUE(router.comments.at(0).message);
  }
  // Words are words, and a slip in one is a slip.
  for (const char* line : {"M0 T1", "M0 (stop)", "M1 G1X5 F100", "M0"}) {
    ProgramEvents events;
    EXPECT_TRUE(run_text(std::string(line) + "\n", events)) << line;
    EXPECT_THAT(events.words, Not(IsEmpty()));
  }
  ProgramEvents events;
  EXPECT_TRUE(run_text("M117 Drawing a cat\nM300 S440 P200\nM118 E1 done\n", events, {.passes_plotter_codes = true}));
  EXPECT_EQ(events.words.at(0).text, "M117 Drawing a cat");
  EXPECT_FALSE(run_text("M117 Drawing a cat\n", events));
}

TEST(RelativeProgram, NeedsAPlaceToStartFrom) {
  for (const char* move : {"G1 X5", "G0 Y-5", "G2 I5", "G81 X1 Z-1 R1"}) {
    const std::string rest = fmt::format("G21\nG91\nG1 Z1 F100\n{}\nM2\n", move);
    EXPECT_THAT(check(rest).problems, ElementsAre("unknown_start 4")) << move;
    // The line that the message gives mends it.
    const Checked mended = check("G90 G0 X0 Y0\n" + rest);
    EXPECT_THAT(check(rest).words, HasSubstr("add a first line")) << move;
    EXPECT_TRUE(mended.succeeds()) << move << "\n" << mended.words;
    EXPECT_TRUE(check("G92 X0 Y0\n" + rest).succeeds()) << move;
  }
  EXPECT_THAT(check("G91 G20\nG90 G0 X1\nG91 G1 Y1 F9\nM2\n").problems, ElementsAre("unknown_start 3"));
}

TEST(StateLeft, IsSaidAtTheEnd) {
  const auto left = [](const std::string& line) {
    return check("G21 G90\nG0 X1 Y1\n" + line + "\nG0 X2\nM30\n");
  };
  EXPECT_THAT(left("").notes, IsEmpty());
  for (const auto& [line, word] : {std::pair("G91", "(G91)"), std::pair("G20", "(G20)"),
                                   std::pair("G92 X0", "offset"), std::pair("G52 Z1", "offset"),
                                   std::pair("G55", "G55"), std::pair("G59.3", "G59.3")}) {
    EXPECT_THAT(left(line).notes, ElementsAre("state_left")) << line;
    EXPECT_THAT(left(line).words, HasSubstr(word));
  }
  EXPECT_THAT(check("G21 G90\nG92 X0 Y0\nG0 X1 Y1\nG92.1\nG91\nG90\nM2\n").notes, IsEmpty());
}

TEST(OtherFiles, AreNamed) {
  for (const char* text : {"<!DOCTYPE html>\n<html>\n", "\n\n  <html lang=\"en\">\n", "<?xml version=\"1.0\"?>\n",
                           "<svg width=\"10\">\n", "{\\rtf1\\ansi G0 X1}\n", "{\"a\": 1}\n", "%PDF-1.4\n",
                           "PK\x03\x04zip\n", "solid part\n", "G21\n<div>G0 X1</div>\n"}) {
    const Checked found = check(text);
    EXPECT_THAT(found.problems, ElementsAre(testing::StartsWith("not_a_program"))) << text;
  }
}

/// Every program whose line ends a mail program or an editor lost is refused, or moves nothing.
TEST(LostLineEnds, NeverSucceed) {
  const std::vector<std::string> programs{
      "(made by a CAM)\nG17 G90\nG21\nG0 Z6\nG0 X10 Y10\nG1 Z-1 F60\nG1 X20\nG0 Z6\nM2\n",
      "; by a slicer\nG21 ; mm\nG90 ; absolute\nG0 X10 Y10\nG1 Z-1 F100\nG1 X20\n",
      "%\nG21\nG0X1Y1\nX2Y2\nX3\nX4Y1\nM30\n%\n",
      "G21\nG90\nG0 Z5 ; up\nG0 X1 Y1\nG1 Z-1 F100\nG1 X5\nM2\n",
      "G20 G90\nG0 X1 Y1\nG1 Z-0.1 F10\nX2\nY2\nX1\nY1\nM5\nM2\n",
      text_of(std::filesystem::path(CHAINTRUE_FIXTURES) / "gcode/bracket.nc"),
  };
  for (const std::string& program : programs) {
    ASSERT_TRUE(check(program).succeeds()) << program << check(program).words;
    for (const char* between : {" ", "", "\t"}) {
      std::string joined;
      for (const char c : program) joined += c == '\n' ? between : std::string(1, c);
      const Checked found = check(joined);
      EXPECT_FALSE(found.succeeds()) << joined;
      EXPECT_THAT(found.words, HasSubstr("line ends")) << joined;
    }
  }
}

TEST(Program, ThatMovesNothingIsNoSuccess) {
  for (const char* text : {"", "\n", "(a title)\n", "G21 G90\nM30\n", "M3 S1000\nG4 P5\nM5\n", "%\n%\n",
                           "G92 X0 Y0\nM2\n", "G28.1\n"}) {
    EXPECT_THAT(check(text).problems, ElementsAre(testing::StartsWith("moves_nothing"))) << text;
  }
  for (const char* text : {"G0 Z5\n", "G53 G0 Z-1\n", "G28 G91 Z0\nG90\n", "G0 X0 Y0\n"})
    EXPECT_TRUE(check(text).succeeds()) << text << check(text).words;
}

TEST(ArcExtents, AreExact) {
  constexpr unsigned kSeed = 53;
  SCOPED_TRACE(fmt::format("seed {}", kSeed));
  std::mt19937_64 random(kSeed);
  const auto uniform = [&](double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  };
  constexpr int kLooks = 20000;
  for (int i = 0; i < 60; ++i) {
    const double radius = uniform(1.0, 300.0);
    const double start = uniform(-4.0, 4.0);
    const double sweep = uniform(0.01, 7.0);
    const char* plane = i % 3 == 0 ? "G17" : i % 3 == 1 ? "G18" : "G19";
    const char* words[] = {"XYIJ", "ZXKI", "YZJK"};
    const char* w = words[i % 3];
    const std::string program =
        fmt::format("G21 G90 F100\nG10 L2 P1 R{}\n{} G0 X0 Y0 Z0\n{} {}{:.9f} {}{:.9f} {}{:.9f} {}{:.9f} P{}\n",
                    i % 3 == 0 ? uniform(-90.0, 90.0) : 0.0,
                    plane,
                    i % 2 == 0 ? "G2" : "G3",
                    w[0], radius * (std::cos(start + sweep) - std::cos(start)),
                    w[1], radius * (std::sin(start + sweep) - std::sin(start)),
                    w[2], -radius * std::cos(start),
                    w[3], -radius * std::sin(start),
                    1 + i % 4);
    ProgramEvents events;
    ASSERT_TRUE(run_text(program, events)) << program;
    const Move& move = events.moves.back();
    for (const auto axis : {&Point::x_mm, &Point::y_mm, &Point::z_mm}) {
      double least = 1e9, most = -1e9, low = 1e9, high = -1e9;
      for (const double t : bounding_places(move)) {
        least = std::min(least, at(move, t).*axis);
        most = std::max(most, at(move, t).*axis);
      }
      for (int k = 0; k <= kLooks; ++k) {
        const double value = at(move, static_cast<double>(k) / kLooks).*axis;
        low = std::min(low, value);
        high = std::max(high, value);
      }
      // Words of nine decimals leave the radii different by 1e-9, and a look misses the top of the arc
      // by r (1 - cos(half a step)).
      const double step = std::fabs(move.arc->sweep_rad) / kLooks;
      const double missed = 2.0 * radius * (1.0 - std::cos(0.5 * step)) + 1e-8;
      EXPECT_LE(least, low + 1e-8) << program;
      EXPECT_GE(most, high - 1e-8) << program;
      EXPECT_GE(least, low - missed) << program;
      EXPECT_LE(most, high + missed) << program;
    }
  }
}

/// A ring of arcs of so many degrees each, G3, and the same with G2 in its place.
std::string ring(double degrees, const char* code) {
  std::string text = "G21 G90 F300\nG0 X100 Y0\n";
  double x = 100.0, y = 0.0;
  for (int i = 1; i <= 3; ++i) {
    const double angle = i * degrees * std::numbers::pi / 180.0;
    const double nx = 100.0 * std::cos(angle), ny = 100.0 * std::sin(angle);
    text += fmt::format("{} X{:.6f} Y{:.6f} I{:.6f} J{:.6f}\n", code, nx, ny, -x, -y);
    x = nx;
    y = ny;
  }
  return text + "M2\n";
}

TEST(ArcsTheLongWay, AreSaidWhereAllAre) {
  for (const double degrees : {5.0, 45.0, 120.0, 179.0}) {
    EXPECT_THAT(check(ring(degrees, "G3")).notes, IsEmpty()) << degrees;
    EXPECT_THAT(check(ring(degrees, "G2")).notes, ElementsAre("arcs_long")) << degrees;
  }
  const std::string circles = "G21 G90 F300\nG0 X0 Y0\nG2 I5\nG2 I9\nG3 I5\nM2\n";
  EXPECT_THAT(check(circles).notes, IsEmpty());
  EXPECT_THAT(check("G21 G90 F300\nG0 X10 Y0\nG3 X0 Y-10 I-10\nG0 X10 Y0\nG3 X0 Y10 I-10\nM2\n").notes, IsEmpty());
}

TEST(BadArcs, AreAllNamedInTheProgramsUnit) {
  const std::string arcs =
      "G90 G17 F20\nG0 X0 Y0\nG2 X1 Y0 I0.3 J0\nG1 X2\nG3 X3 Y1 R0.5\nG2 X4 Y1 I0.5 J0\nG2 X5 Y1 I0.7 J0\nM2\n";
  for (const auto& [unit, word] : {std::pair("G20", "0.3000 inch at the start and 0.7000 inch"),
                                   std::pair("G21", "0.3000 mm at the start and 0.7000 mm")}) {
    const Checked found = check(unit + (" " + arcs));
    EXPECT_THAT(found.problems, ElementsAre("bad_arc 3", "bad_arc 5", "bad_arc 7"));
    EXPECT_THAT(found.words, HasSubstr(word));
  }
}

TEST(SheetThatNobodyStated, IsNamed) {
  const std::string program = "G21 G90\nG0 X0 Y700\nM2\n";
  EXPECT_THAT(check(program).words, AllOf(HasSubstr("90.40 mm outside the sheet, taken to be 2438.4 x 1219.2 mm")));
  auto source = LineSource::from_text(program);
  Findings findings;
  ASSERT_TRUE(survey(source, {}, {kUsualSheet.area, false}, findings));
  EXPECT_THAT(findings.problems.at(0).sentence, Not(HasSubstr("taken")));
}

/// What check says of each file that an owner brought; "" is a success without a note.
struct Report {
  const char* file;
  std::vector<std::string> problems;
  std::vector<std::string> notes;
};

TEST(Reports, AreAnsweredByTheirKind) {
  const std::filesystem::path folder = std::filesystem::path(CHAINTRUE_SHARED_DATA) / "reports";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no reports at " << folder;
  const std::vector<Report> reports{
      {"01_g53_retract.nc", {}, {}},
      {"14_freecad_k0.nc", {}, {}},
      {"15_marlin_plotter.gcode", {}, {"home_assumed", "no_program_end"}},
      {"17_relative_only.nc", {"unknown_start 5"}, {"units_assumed", "no_program_end", "state_left"}},
      {"23_web_page.nc", {"not_a_program 1"}, {}},
      {"24_line_ends_lost.nc", {"line_ends_lost 1"}, {}},
      {"25_which_sheet.nc", {"outside_sheet 3", "outside_sheet 5"}, {}},
      {"29_arcs_the_long_way.nc", {}, {"arcs_long"}},
  };
  std::size_t programs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string extension = entry.path().extension().string();
    programs += extension == ".nc" || extension == ".gcode" ? 1U : 0U;
  }
  EXPECT_EQ(programs, reports.size()) << "each has its line";
  for (const Report& report : reports) {
    const Checked found = check(text_of(folder / report.file));
    EXPECT_EQ(found.problems, report.problems) << report.file << "\n" << found.words;
    EXPECT_THAT(found.notes, testing::UnorderedElementsAreArray(report.notes)) << report.file;
  }
}

/// Every program there is ends with moves, or with a problem that has a name and a line.
TEST(EveryProgram, MovesOrIsRefusedByName) {
  std::vector<std::filesystem::path> programs;
  for (const auto& folder : {std::filesystem::path(CHAINTRUE_SHARED_DATA) / "gcode",
                             std::filesystem::path(CHAINTRUE_FIXTURES)}) {
    if (!std::filesystem::exists(folder)) continue;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
      const std::string extension = entry.path().extension().string();
      for (const char* own : {".nc", ".ngc", ".gcode", ".EIA"}) {
        if (extension == own) programs.push_back(entry.path());
      }
    }
  }
  EXPECT_FALSE(programs.empty());
  for (const auto& path : programs) {
    const Checked found = check(text_of(path));
    if (found.succeeds()) {
      ASSERT_TRUE(found.survey) << path;
      EXPECT_GT(found.survey->rapids + found.survey->feeds + found.survey->arcs + found.survey->probes, 0U) << path;
    } else {
      EXPECT_THAT(found.problems.front(), Not(testing::EndsWith(" 0"))) << path << "\n" << found.words;
    }
  }
}

}  // namespace
}  // namespace chaintrue::gcode
