// SPDX-License-Identifier: GPL-3.0-or-later
#include "interp/compiled_pair.hpp"

#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "tests/support/in_threads.hpp"
#include "tests/interp/truths.hpp"

namespace chaintrue::interp {
namespace {

using truths::even;
using truths::kBed;
using truths::sample;

constexpr std::uint64_t kCompiledSeed = 97;

std::array<double, 2> chains(double x, double y) {
  return {truths::wrapped_chain(x, y, -1.0), truths::wrapped_chain(x, y, 1.0)};
}

std::vector<PlanePoint> random_points(std::uint64_t seed, std::size_t count, double margin) {
  truths::Random random(seed);
  std::vector<PlanePoint> points;
  for (std::size_t k = 0; k < count; ++k) {
    points.push_back({random.uniform(kBed.x_min - margin, kBed.x_max + margin),
                      random.uniform(kBed.y_min - margin, kBed.y_max + margin)});
  }
  return points;
}

TEST(CompiledPair, IsTheTwoSplinesAlsoOutside) {
  SCOPED_TRACE(kCompiledSeed);
  const auto x = even(kBed.x_min, kBed.x_max, 7);
  const auto y = even(kBed.y_min, kBed.y_max, 4);
  const TensorSpline left(x, y, sample(x, y, [](double a, double b) { return chains(a, b)[0]; }));
  const TensorSpline right(x, y, sample(x, y, [](double a, double b) { return chains(a, b)[1]; }));
  const CompiledPair table = CompiledPair::from_splines(left, right);
  for (const PlanePoint& p : random_points(kCompiledSeed, 2000, 100.0)) {
    const PairGradient z = table.at(p.x, p.y);
    const TensorSpline* splines[] = {&left, &right};
    for (std::size_t k = 0; k < 2; ++k) {
      const ValueGradient expected = splines[k]->at(p.x, p.y);
      EXPECT_NEAR(z.value[k], expected.value, 1e-10);  // rounding of 3000 mm, a few times
      EXPECT_NEAR(z.dx[k], expected.dx, 1e-12);
      EXPECT_NEAR(z.dy[k], expected.dy, 1e-12);
    }
  }
}

TEST(CompiledPair, EveryInstructionSetAndThreadCountGivesTheSameBits) {
  SCOPED_TRACE(kCompiledSeed);
  const CompiledPair table = CompiledPair::compile(kBed, 24, 12, chains);
  const auto points = random_points(kCompiledSeed + 1, 5000, 200.0);
  std::vector<PairGradient> expected(points.size());
  force_plain_instructions(true);
  table.at(points, expected);
  force_plain_instructions(false);
  for (const std::size_t threads : {1U, 2U, 3U, 7U}) {
    std::vector<PairGradient> results(points.size());
    std::vector<std::function<void()>> parts;
    for (std::size_t t = 0; t < threads; ++t) {
      parts.emplace_back([&, t] {
        const std::size_t first = points.size() * t / threads;
        const std::size_t count = points.size() * (t + 1) / threads - first;
        table.at(std::span(points).subspan(first, count), std::span(results).subspan(first, count));
      });
    }
    testing_support::run_in_threads(parts);
    EXPECT_EQ(0,
              std::memcmp(results.data(), expected.data(), results.size() * sizeof(PairGradient)))
        << threads << " threads, " << compiled_pair_instructions();
  }
}

TEST(CompiledPair, StatesABoundThatHolds) {
  SCOPED_TRACE(kCompiledSeed);
  for (const auto& [nx, ny] : {std::pair{12, 6}, {25, 13}, {100, 50}}) {
    const CompiledPair table = CompiledPair::compile(kBed, nx, ny, chains);
    double worst = 0.0;
    for (const PlanePoint& p : random_points(kCompiledSeed + 2, 20000, 0.0)) {
      const auto exact = chains(p.x, p.y);
      const auto ours = table.value(p.x, p.y);
      worst = std::max({worst, std::abs(exact[0] - ours[0]), std::abs(exact[1] - ours[1])});
    }
    EXPECT_LE(worst, table.error().bound) << nx;
    EXPECT_GE(worst, 0.3 * table.error().bound) << nx;  // a useful bound is near the actual error
    if (nx == 100) {
      EXPECT_LE(table.error().bound, 0.005);
    }
  }
}

TEST(CompiledPair, InverseReturnsEveryPointOfAPathInFourEvaluations) {
  const CompiledPair table = CompiledPair::compile(kBed, 100, 50, chains);
  std::vector<PlanePoint> path;
  for (int row = 0; row < 6; ++row) {
    for (int i = 0; i < 1200; ++i) {
      const double x = -1199.0 + 2.0 * (row % 2 == 0 ? i : 1199 - i);
      path.push_back({x, -600.0 + 240.0 * row});
    }
  }
  std::vector<std::array<double, 2>> targets;
  for (const PlanePoint& p : path) targets.push_back(table.value(p.x, p.y));
  std::vector<InverseResult> results(path.size());
  table.inverse(targets, path.front(), results);
  for (std::size_t k = 0; k < path.size(); ++k) {
    ASSERT_EQ(results[k].status, InverseStatus::converged) << k;
    ASSERT_NEAR(results[k].x, path[k].x, 1e-9) << k;  // the required tolerance
    ASSERT_NEAR(results[k].y, path[k].y, 1e-9) << k;
    const bool jump = k % 1200 == 0;
    EXPECT_LE(results[k].evaluations, jump ? 6 : 4) << k;
  }
}

TEST(CompiledPair, InverseFindsEveryPointFromTheMiddleOfTheBed) {
  SCOPED_TRACE(kCompiledSeed);
  const CompiledPair table = CompiledPair::compile(kBed, 100, 50, chains);
  for (const PlanePoint& p : random_points(kCompiledSeed + 3, 4000, 0.0)) {
    const InverseResult r = table.inverse(table.value(p.x, p.y), {0.0, 0.0});
    ASSERT_EQ(r.status, InverseStatus::converged) << p.x << " " << p.y;
    EXPECT_NEAR(r.x, p.x, 1e-9);
    EXPECT_NEAR(r.y, p.y, 1e-9);
  }
}

TEST(CompiledPair, InverseNamesWhatItCannotAnswer) {
  const CompiledPair table = CompiledPair::compile(kBed, 50, 25, chains);
  const auto alongside = table.value(kBed.x_max + 30.0, 0.0);
  EXPECT_EQ(table.inverse(alongside, {1000.0, 0.0}).status, InverseStatus::outside);
  // Chains too short to meet: 3000 mm lie between the motors.
  EXPECT_EQ(table.inverse({1000.0, 1000.0}, {0.0, 0.0}).status, InverseStatus::not_converged);
  EXPECT_EQ(table.inverse({NAN, 1000.0}, {0.0, 0.0}).status, InverseStatus::not_converged);
}

TEST(CompiledPair, RefusesWhatItCannotCompile) {
  EXPECT_THROW((void)CompiledPair::compile({0, 0, 0, 1}, 2, 2, chains), std::invalid_argument);
  EXPECT_THROW((void)CompiledPair::compile(kBed, 0, 2, chains), std::invalid_argument);
  EXPECT_THROW((void)CompiledPair::compile(kBed,
                                           4,
                                           4,
                                           [](double, double) {
                                             return std::array<double, 2>{NAN, 0.0};
                                           }),
               std::invalid_argument);
  const TensorSpline a({0, 1, 3}, {0, 1}, Eigen::MatrixXd::Zero(3, 2));
  EXPECT_THROW((void)CompiledPair::from_splines(a, a), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::interp
