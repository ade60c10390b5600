// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The matcher's decision, compared with the discrete Frechet distance of densely sampled curves,
/// which differs from the true one by less than the samples' spacing (Eiter and Mannila, "Computing
/// discrete Frechet distance", TU Wien, CD-TR 94/64, 1994, theorem 4).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tools/gcode/path.hpp"
#include "tools/gcode/path_matcher.hpp"

namespace chaintrue::gcode {
namespace {

using Polyline = std::vector<Point>;

Polyline sampled(const Polyline& curve, double spacing) {
  Polyline result{curve.front()};
  for (std::size_t i = 1; i < curve.size(); ++i) {
    const int pieces = static_cast<int>(std::ceil(distance_mm(curve[i - 1], curve[i]) / spacing));
    for (int k = 1; k <= pieces; ++k)
      result.push_back(between(curve[i - 1], curve[i], static_cast<double>(k) / pieces));
  }
  return result;
}

double discrete_frechet(const Polyline& a, const Polyline& b) {
  std::vector<double> row(b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    double corner = 0.0;
    for (std::size_t k = 0; k < b.size(); ++k) {
      const double before = row[k];
      double reach = 0.0;
      if (i > 0 && k > 0) {
        reach = std::min({corner, before, row[k - 1]});
      } else if (i > 0) {
        reach = before;
      } else if (k > 0) {
        reach = row[k - 1];
      }
      row[k] = std::max(reach, distance_mm(a[i], b[k]));
      corner = before;
    }
  }
  return row.back();
}

bool follows(const Polyline& path, const Polyline& track, double distance) {
  std::size_t next = 1;
  PathMatcher matcher({.distance_mm = distance, .speed_share = 0.1, .least_run_mm = 1e9},
                      [&](PathPiece& piece) {
                        if (next >= path.size()) return false;
                        piece = {path[next++], false, 100.0, next};
                        return true;
                      });
  if (matcher.begin({0.0, path.front(), track.front()}) != PathMatcher::Outcome::follows)
    return false;
  for (std::size_t i = 1; i < track.size(); ++i) {
    if (matcher.advance({track[i], false, 100.0, i}) != PathMatcher::Outcome::follows) return false;
  }
  return matcher.finish() == PathMatcher::Outcome::follows;
}

/// A curve that winds, crosses itself and reverses; and another one near it.
TEST(PathMatcher, DecidesTheFrechetDistance) {
  constexpr std::uint64_t kSeed = 4;
  constexpr double kSpacing = 0.02;
  std::mt19937_64 random(kSeed);
  const auto uniform = [&random](double most) {
    return most * (2.0 * static_cast<double>(random() >> 11) * 0x1p-53 - 1.0);
  };
  int decided_near = 0;
  for (int round = 0; round < 60; ++round) {
    Polyline path{{0.0, 0.0, 0.0}};
    const int corners = 3 + round % 9;
    for (int i = 0; i < corners; ++i) {
      path.push_back({path.back().x_mm + uniform(2.0), path.back().y_mm + uniform(2.0),
                      path.back().z_mm + uniform(0.5)});
    }
    Polyline track;
    for (const Point& p : sampled(path, 0.7)) {
      track.push_back({p.x_mm + uniform(0.3), p.y_mm + uniform(0.3), p.z_mm + uniform(0.1)});
    }
    if (round % 4 == 0) std::swap(track[track.size() / 2], track[track.size() / 2 - 1]);
    const double distance = discrete_frechet(sampled(path, kSpacing), sampled(track, kSpacing));
    EXPECT_TRUE(follows(path, track, distance + kSpacing)) << "round " << round;
    EXPECT_FALSE(follows(path, track, distance - kSpacing)) << "round " << round;
    // Equal up to the rounding of a square root.
    decided_near += follows(path, track, distance * (1.0 + 1e-9)) ? 1 : 0;
  }
  // The continuous distance is never above the discrete one.
  EXPECT_EQ(decided_near, 60);
}

/// Every point is on the path, but not in its order.
TEST(PathMatcher, ReportsGoingBack) {
  const Polyline path{{0, 0, 0}, {100, 0, 0}};
  EXPECT_TRUE(follows(path, {{0, 0, 0}, {60, 0, 0}, {100, 0, 0}}, 0.05));
  EXPECT_FALSE(follows(path, {{0, 0, 0}, {60, 0, 0}, {50, 0, 0}, {100, 0, 0}}, 0.05));
  EXPECT_TRUE(follows(path, {{0, 0, 0}, {60, 0, 0}, {59.92, 0, 0}, {100, 0, 0}}, 0.05));
  EXPECT_FALSE(follows(path, {{0, 0, 0}, {99.9, 0, 0}}, 0.05));
  EXPECT_FALSE(follows({{0, 0, 0}, {9, 0, 0}, {9, 9, 0}, {0, 0, 0}}, {{0, 0, 0}}, 0.05));
}

}  // namespace
}  // namespace chaintrue::gcode
