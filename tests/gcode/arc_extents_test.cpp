// SPDX-License-Identifier: GPL-3.0-or-later
// How far an arc reaches. Programs as owners bring them: tests/cli/cases/owners_programs.cases.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "tests/gcode/program_events.hpp"
#include "tools/gcode/path.hpp"

namespace chaintrue::gcode {
namespace {

TEST(ArcExtents, MatchTheExactCurve) {
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
    const std::string program = fmt::format(
        "G21 G90 F100\nG10 L2 P1 R{}\n{} G0 X0 Y0 Z0\n{} {}{:.9f} {}{:.9f} {}{:.9f} {}{:.9f} P{}\n",
        i % 3 == 0 ? uniform(-90.0, 90.0) : 0.0, plane, i % 2 == 0 ? "G2" : "G3", w[0],
        radius * (std::cos(start + sweep) - std::cos(start)), w[1],
        radius * (std::sin(start + sweep) - std::sin(start)), w[2], -radius * std::cos(start), w[3],
        -radius * std::sin(start), 1 + i % 4);
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

}  // namespace
}  // namespace chaintrue::gcode
