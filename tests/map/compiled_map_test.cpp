// SPDX-License-Identifier: GPL-3.0-or-later
// The table of a fitted map keeps its bound everywhere, and the bound is one that can be used.
#include "grid/map/compiled_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "grid/map/fit.hpp"
#include "grid/synthetic/random.hpp"
#include "tests/map/synthetic_grid.hpp"

namespace chaintrue {
namespace {

using grid::CompensationMap;

CompensationMap fitted(bool noisy) {
  auto spec = testing_support::usual_spec(12);
  if (!noisy) {
    spec.noise = {};
    spec.repeats = 0;
    spec.jitter_mm = 0.0;
    spec.unmodelled_mm = 0.5;
  }
  auto map = grid::fit(grid::synthetic::generate(model::Machine{}, spec).value().grid);
  if (!map) throw std::runtime_error(map.error().sentence);
  return *std::move(map);
}

class CompiledMap : public testing::TestWithParam<bool> {};

TEST_P(CompiledMap, KeepsItsBoundAtAnyPoint) {
  const CompensationMap map = fitted(GetParam());
  ASSERT_EQ(std::get<grid::ModelSurface>(map.contents().surface).lattice.has_value(), !GetParam());
  const auto table = grid::compile(map);
  ASSERT_TRUE(table);
  EXPECT_LE(table->error().bound, 0.005);  // mm: a fortieth of a usual reading's noise
  EXPECT_GT(table->error().bound, 0.0);
  const interp::Rectangle& domain = map.contents().domain;
  constexpr std::uint64_t kSeed = 31;
  SCOPED_TRACE(kSeed);
  grid::synthetic::Random random(kSeed);
  for (int i = 0; i < 20000; ++i) {
    const model::BedPoint p{domain.x_min + domain.width() * random.uniform(),
                            domain.y_min + domain.height() * random.uniform()};
    const auto exact = map.lengths(p).value();
    const auto ours = table->at(p.x_mm, p.y_mm);
    ASSERT_NEAR(ours.value[0], exact.lengths.left_mm, table->error().bound);
    ASSERT_NEAR(ours.value[1], exact.lengths.right_mm, table->error().bound);
    // A cubic's slope errs by some 8 of its errors in a cell, here of 24 mm.
    ASSERT_NEAR(ours.dx[0], exact.mark_jacobian(0, 0), 8.0 * table->error().bound / 24.0);
    ASSERT_NEAR(ours.dy[1], exact.mark_jacobian(1, 1), 8.0 * table->error().bound / 24.0);
  }
}

TEST(CompiledMapOfAnEccentricSprocket, IsNotMade) {
  model::Machine machine;
  machine.effects.push_back(
      {"sprocket_eccentricity", "left", {{"amplitude_mm", 0.3}, {"phase_rad", 1.0}}});
  const auto map =
      grid::fit(grid::synthetic::generate(machine, testing_support::usual_spec(12)).value().grid);
  ASSERT_TRUE(map) << map.error().sentence;
  const auto table = grid::compile(*map);
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error(), grid::MapFailure::wave_along_chain);
}

TEST_P(CompiledMap, FindsThePointThatTheMapFinds) {
  const CompensationMap map = fitted(GetParam());
  const auto table = grid::compile(map);
  ASSERT_TRUE(table);
  for (const model::BedPoint p : {model::BedPoint{0, 0}, {-1100, -500}, {900, 400}}) {
    const auto lengths = map.lengths(p).value().lengths;
    const auto found = table->inverse({lengths.left_mm, lengths.right_mm}, {0.0, 0.0});
    EXPECT_EQ(found.status, interp::InverseStatus::converged);
    // The chains meet at more than 20 degrees on the bed: at most three times their error.
    EXPECT_NEAR(found.x, p.x_mm, 3.0 * table->error().bound);
    EXPECT_NEAR(found.y, p.y_mm, 3.0 * table->error().bound);
  }
}

INSTANTIATE_TEST_SUITE_P(Maps, CompiledMap, testing::Bool(), [](const auto& noisy) {
  return noisy.param ? "Noisy" : "Lattice";
});

TEST(CompiledMapCoarse, SaysThatItIsCoarse) {
  const CompensationMap map = fitted(true);
  EXPECT_GT(grid::compile(map, 12, 6)->error().bound, 10.0 * grid::compile(map)->error().bound);
}

TEST(CompiledMapRefusal, TakesPositiveCountsOnly) {
  const CompensationMap map = fitted(true);
  EXPECT_THROW(static_cast<void>(grid::compile(map, 0, 50)), std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue
