// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compensated files on a simulated machine, checked by a follower that shares no code with
/// tools/gcode; and that follower checked against LinuxCNC's stored moves and distances known in
/// closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/gcode_witness/follower/path_distance.hpp"
#include "tests/gcode_witness/follower/program_path.hpp"
#include "tests/gcode_witness/support/corpus.hpp"
#include "tests/gcode_witness/support/follow_run.hpp"

namespace chaintrue::witness {
namespace {

using follower::Place;
using follower::within;

TEST(Follower, CompensatedProgramsFollowTheirPaths) {
  FollowOptions options;
  const FollowRun run = follow(CHAINTRUE_FIXTURES, options);
  for (const std::string& failure : run.failures) ADD_FAILURE() << failure;
  EXPECT_EQ(run.failed, 0U) << "of " << run.programs << " programs, seeds from "
                            << options.first_seed;
  EXPECT_GE(run.compensated * 10, run.programs * 8) << "programs that are refused prove nothing";
  EXPECT_GE(run.judged_moved, run.compensated);  // two of each, where it has three commands
}

TEST(PathDistance, IsExactForParallelLines) {
  const std::vector<Place> a = {{0, 0, 0}, {10, 0, 0}};
  const std::vector<Place> b = {{0, 2, 0}, {3, 2, 0}, {10, 2, 0}};
  EXPECT_TRUE(within(a, b, 2.0 + 1e-12));
  EXPECT_FALSE(within(a, b, 2.0 - 1e-12));
}

/// If one path goes back and the other does not, the distance is half the way back.
TEST(PathDistance, CountsWayBack) {
  const std::vector<Place> a = {{0, 0, 0}, {10, 0, 0}};
  const std::vector<Place> b = {{0, 0, 0}, {7, 0, 0}, {3, 0, 0}, {10, 0, 0}};
  EXPECT_TRUE(within(a, b, 2.0 + 1e-9));
  EXPECT_FALSE(within(a, b, 2.0 - 1e-9));
  EXPECT_NEAR(follower::path_distance_mm(a, b, 100.0), 2.0, 0.005);  // a part in 500
}

TEST(PathDistance, DetectsAMissingTurn) {
  std::vector<Place> once;
  std::vector<Place> twice;
  for (int i = 0; i <= 720; ++i) {
    const double angle = i * std::numbers::pi / 180.0;
    const Place place{5.0 * std::cos(angle), 5.0 * std::sin(angle), 0.0};
    twice.push_back(place);
    if (i <= 360) once.push_back(place);
  }
  EXPECT_TRUE(within(twice, twice, 1e-9));
  EXPECT_FALSE(within(once, twice, 4.0));
  // One point waits anywhere on the circle while the other goes round: the distance is at most the
  // diameter.
  EXPECT_TRUE(within(once, twice, 10.0));
}

TEST(PathDistance, IsSymmetricAndOrdered) {
  const std::vector<Place> a = {{0, 0, 0}, {4, 1, 0}, {8, -1, 2}, {12, 0, 0}};
  const std::vector<Place> b = {{0, 1, 0}, {5, 2, 1}, {11, 0, 0}};
  const std::vector<Place> back(b.rbegin(), b.rend());
  const double there = follower::path_distance_mm(a, b, 100.0);
  EXPECT_NEAR(there, follower::path_distance_mm(b, a, 100.0),
              0.004 * there);  // a part in 500, twice
  EXPECT_GT(follower::path_distance_mm(a, back, 100.0), 10.0);
}

/// Appends a position unless it equals the last one: rows of cycles may move to the current
/// position.
void reach(std::vector<Place>& places, const Place& to) {
  // Nine decimals through inches.
  const auto near = [&](std::size_t axis) {
    return std::fabs(places.back()[axis] - to[axis]) <= 1e-6;
  };
  if (places.empty() || !(near(0) && near(1) && near(2))) places.push_back(to);
}

/// The ends of the stored straight moves and arcs. Whole circles end at their start.
std::vector<Place> ends(const Answer& truth) {
  std::vector<Place> result;
  for (const Call& call : truth.calls) {
    if (call.kind == "RAPID" || call.kind == "FEED" || call.kind == "ARC") reach(result, call.to);
  }
  return result;
}

TEST(Follower, EndsItsMovesWhereLinuxCncDoes) {
  const auto programs = stored_programs(CHAINTRUE_FIXTURES, "follower");
  EXPECT_GE(programs.size(), 100U);
  for (const StoredProgram& program : programs) {
    SCOPED_TRACE(program.name + ":\n" + program.text);
    ASSERT_TRUE(program.linuxcnc.accepted);
    std::vector<Place> reached;
    for (const auto& piece : follower::program_path(program.text))
      reach(reached, piece.places.back());
    const auto expected = ends(program.linuxcnc);
    ASSERT_EQ(reached.size(), expected.size());
    for (std::size_t k = 0; k < reached.size(); ++k) {
      // As for our own interpreter: nine decimals through inches.
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(reached[k][axis], expected[k][axis], 1e-6) << "move " << k;
    }
  }
}

}  // namespace
}  // namespace chaintrue::witness
