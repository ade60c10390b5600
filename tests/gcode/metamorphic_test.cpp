// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The same path written in many ways.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <iterator>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "tests/gcode/program_events.hpp"
#include "tools/gcode/moves.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

struct Step {
  bool arc = false;
  bool clockwise = false;
  double x = 0.0, y = 0.0, z = 0.0;  // end, mm
  double cx = 0.0, cy = 0.0;         // centre
  double sweep = 0.0;                // rad, up to a whole turn
};

/// Random lines and arcs; coordinates in steps of 1/64 mm so that sums and differences are exact.
std::vector<Step> random_path(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto grid = [&random](double least, double most) {
    const double u = static_cast<double>(random() >> 11) * 0x1p-53;
    return std::round((least + u * (most - least)) * 64.0) / 64.0;
  };
  std::vector<Step> path;
  double x = 0.0, y = 0.0;
  for (int i = 0; i < 60; ++i) {
    Step step;
    step.z = grid(-5.0, 5.0);
    step.arc = i % 3 == 2;
    if (step.arc) {
      step.clockwise = random() % 2 == 0;
      step.cx = x + grid(5.0, 60.0);
      step.cy = y + grid(5.0, 60.0);
      step.sweep = (step.clockwise ? -1.0 : 1.0) *
                   (0.1 + 5.9 * static_cast<double>(random() >> 11) * 0x1p-53);
      const double c = std::cos(step.sweep), s = std::sin(step.sweep);
      step.x = step.cx + c * (x - step.cx) - s * (y - step.cy);
      step.y = step.cy + s * (x - step.cx) + c * (y - step.cy);
    } else {
      step.x = grid(-500.0, 500.0);
      step.y = grid(-300.0, 300.0);
    }
    x = step.x;
    y = step.y;
    path.push_back(step);
  }
  return path;
}

struct Style {
  std::string name;
  bool inches = false;
  bool incremental = false;
  bool by_radius = false;
  bool absolute_centres = false;
  std::function<std::string(std::string)> noise;
};

/// Twelve decimals: an inch's last place is 2.5e-11 mm, and 60 incremental steps add up to 2e-9.
std::string write(const std::vector<Step>& path, const Style& style) {
  const double unit = style.inches ? 25.4 : 1.0;
  std::string text = fmt::format("{} {} {}\n",
                                 style.inches ? "G20" : "G21",
                                 style.incremental ? "G91" : "G90",
                                 style.absolute_centres ? "G90.1" : "G91.1");
  text += fmt::format("F{:.12f}\n", 600.0 / unit);
  double x = 0.0, y = 0.0, z = 0.0;
  for (const Step& step : path) {
    const double base_x = style.incremental ? x : 0.0, base_y = style.incremental ? y : 0.0,
                 base_z = style.incremental ? z : 0.0;
    text += fmt::format("{} X{:.12f} Y{:.12f} Z{:.12f}",
                        !step.arc        ? "G1"
                        : step.clockwise ? "G2"
                                         : "G3",
                        (step.x - base_x) / unit,
                        (step.y - base_y) / unit,
                        (step.z - base_z) / unit);
    if (step.arc && style.by_radius) {
      const double radius = std::hypot(x - step.cx, y - step.cy) *
                            (std::fabs(step.sweep) > std::numbers::pi ? -1.0 : 1.0);
      text += fmt::format(" R{:.12f}", radius / unit);
    } else if (step.arc) {
      const double from_x = style.absolute_centres ? 0.0 : x,
                   from_y = style.absolute_centres ? 0.0 : y;
      text +=
          fmt::format(" I{:.12f} J{:.12f}", (step.cx - from_x) / unit, (step.cy - from_y) / unit);
    }
    text += '\n';
    x = step.x;
    y = step.y;
    z = step.z;
  }
  return style.noise ? style.noise(text) : text;
}

std::string every_line(const std::string& text,
                       const std::function<std::string(std::string, int)>& change) {
  std::string result;
  std::size_t from = 0;
  for (int number = 1; from < text.size(); ++number) {
    const std::size_t end = text.find('\n', from);
    result += change(text.substr(from, end - from), number);
    from = end + 1;
  }
  return result;
}

std::vector<Style> styles() {
  return {
      {"millimetres", false, false, false, false, {}},
      {"inches", true, false, false, false, {}},
      {"incremental", false, true, false, false, {}},
      {"incremental_inches", true, true, false, false, {}},
      {"by_radius", false, false, true, false, {}},
      {"absolute_centres", false, false, false, true, {}},
      {"incremental_with_absolute_centres", false, true, false, true, {}},
      {"no_blanks",
       false,
       false,
       false,
       false,
       [](std::string text) {
         std::erase(text, ' ');
         return text;
       }},
      {"blanks_everywhere",
       false,
       false,
       false,
       false,
       [](const std::string& text) {
         std::string wide;
         for (const char c : text) wide += c == '\n' ? std::string("\n") : fmt::format(" {}\t", c);
         return wide;
       }},
      {"small_letters",
       false,
       false,
       false,
       false,
       [](std::string text) {
         for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
         return text;
       }},
      {"line_numbers",
       false,
       false,
       false,
       false,
       [](const std::string& text) {
         return every_line(text, [](const std::string& line, int n) {
           return fmt::format("N{} {}\n", 10 * n, line);
         });
       }},
      {"crlf",
       false,
       false,
       false,
       false,
       [](const std::string& text) {
         return every_line(text, [](const std::string& line, int) { return line + "\r\n"; });
       }},
      {"comments",
       false,
       false,
       false,
       false,
       [](const std::string& text) {
         return every_line(
             text, [](const std::string& line, int) { return "(G0 X7)" + line + "; G0 X9\n"; });
       }},
      {"checksums",
       false,
       false,
       false,
       false,
       [](const std::string& text) {
         return every_line(text, [](const std::string& line, int) {
           unsigned sum = 0;
           for (const char c : line) sum ^= static_cast<unsigned char>(c);
           return fmt::format("{}*{}\n", line, sum);
         });
       }},
      {"expressions",
       false,
       false,
       false,
       false,
       [](const std::string& text) {
         return every_line(text, [](const std::string& line, int) {
           std::string result;
           for (std::size_t i = 0; i < line.size(); ++i) {
             if (line[i] != 'X') {
               result += line[i];
               continue;
             }
             const std::size_t end = std::min(line.find(' ', i), line.size());
             result += "X[0 + " + line.substr(i + 1, end - i - 1) + "]";
             i = end - 1;
           }
           return result + "\n";
         });
       }},
  };
}

class OnePath : public testing::TestWithParam<Style> {};

TEST_P(OnePath, WrittenInAnotherWayIsTheSame) {
  for (const std::uint64_t seed : {11ULL, 12ULL, 13ULL}) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto path = random_path(seed);
    auto plain = LineSource::from_text(write(path, styles().front()));
    auto other = LineSource::from_text(write(path, GetParam()));
    const auto expected = read_moves(plain);
    const auto found = read_moves(other);
    ASSERT_TRUE(expected);
    ASSERT_TRUE(found) << found.error().message();
    ASSERT_EQ(found->size(), expected->size());
    for (std::size_t i = 0; i < found->size(); ++i) {
      const Move& a = (*expected)[i];
      const Move& b = (*found)[i];
      ASSERT_EQ(a.kind, b.kind);
      ASSERT_NEAR(a.feed.value, b.feed.value, 1e-9);
      for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        // Written to twelve decimals; a centre by radius is worse conditioned near half circles.
        ASSERT_LT(distance_mm(at(a, t), at(b, t)), 1e-5) << "move " << i << " at " << t;
      }
      ASSERT_LT(distance_mm(a.to, b.to), 5e-9) << "the end of move " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Styles, OnePath, testing::ValuesIn(styles()), [](const auto& style) {
  return style.param.name;
});

/// A shift of the work offset that the words compensate, a rotation of 90 degrees with exchanged
/// words.
TEST(OnePath, IsTheSameThroughOffsetsAndRotations) {
  const auto ends = [](const std::string& text) {
    auto source = LineSource::from_text(text);
    const auto moves = read_moves(source);
    EXPECT_TRUE(moves) << moves.error().message();
    return moves ? *moves : std::vector<Move>{};
  };
  const auto plain = ends("F9 G1 X10 Y20\nG3 X30 Y40 I0 J20\nG1 X0 Y0\n");
  for (const char* text : {"G10 L2 P1 X100 Y-7\nF9 G1 X-90 Y27\nG3 X-70 Y47 I0 J20\nG1 X-100 Y7\n",
                           "G92 X5 Y5\nF9 G1 X15 Y25\nG3 X35 Y45 I0 J20\nG1 X5 Y5\n",
                           "G10 L2 P3 R90\nG56 F9 G1 X20 Y-10\nG3 X40 Y-30 I20 J0\nG1 X0 Y0\n",
                           "G52 X-3\nF9 G1 X13 Y20\nG3 X33 Y40 I0 J20\nG53 G1 X0 Y0\n"}) {
    SCOPED_TRACE(text);
    const auto moves = ends(text);
    ASSERT_EQ(moves.size(), plain.size());
    for (std::size_t i = 0; i < plain.size(); ++i) {
      for (const double t : {0.3, 0.7, 1.0})
        EXPECT_LT(distance_mm(at(plain[i], t), at(moves[i], t)), 1e-12);
    }
  }
}

}  // namespace
}  // namespace chaintrue::gcode
