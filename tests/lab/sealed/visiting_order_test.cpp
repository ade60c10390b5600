// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Unrecorded orders of visits, estimated from readings of the hidden machine.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <utility>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/order_search.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/binomial.hpp"

namespace chaintrue::sealed {
namespace visits {
namespace {

using generator::Cause;
using generator::Order;
using grid::VisitingOrder;
using grid::diagnosis::VisitingOrderFound;

grid::MeasuredGrid without_numbers(const generator::SealedSet& set) {
  grid::MeasuredGrid grid = grid::files::parse_grid(set.grid_text, "sealed.json").grid;
  for (grid::MeasuredPoint& point : grid.points) point.order.reset();
  return grid;
}

std::optional<VisitingOrderFound> found_in(const grid::MeasuredGrid& grid) {
  const grid::Measured measured(grid);
  const auto session = grid::diagnosis::observations_of(measured);
  const auto analysis = grid::diagnosis::analyse(session.value(), {});
  return grid::diagnosis::find_visiting_order(measured, analysis.value());
}

/// The generator begins at the bottom left.
VisitingOrder drawn(Order order) {
  return {.rows = order == Order::rows || order == Order::serpentine_rows,
          .serpentine = order == Order::serpentine_rows || order == Order::serpentine_columns,
          .from_right = false,
          .from_below = true};
}

struct Counts {
  int right = 0;
  int wrong = 0;
};

Counts count(Order order, std::optional<Cause> cause, int sets, std::uint64_t first_seed) {
  Counts counts;
  constexpr int kPoints[] = {28, 60, 117};
  for (int k = 0; k < sets; ++k) {
    generator::Recipe recipe;
    recipe.kind = cause ? generator::Mix::single : generator::Mix::nothing;
    recipe.points = kPoints[k % 3];
    recipe.order = order;
    recipe.cause = cause;
    const auto found = found_in(
        without_numbers(generator::draw_set(recipe, first_seed + static_cast<std::uint64_t>(k))));
    if (!found) continue;
    const VisitingOrder truth = drawn(order);
    EXPECT_FALSE(found->corner_known);  // marks were measured again
    const bool same = found->order.rows == truth.rows && found->order.serpentine == truth.serpentine;
    ++(same && order != Order::random ? counts.right : counts.wrong);
  }
  return counts;
}

/// For 120 sets. Each expectation fails by chance once in a thousand runs.
constexpr int kSets = 120;

// Friction of strength 6 to 22, six marks measured again in between; of 200 sets 137 and 166 were found.
// Fails in 97 of 100 runs where 45 and 62 % are found.
TEST(Sealed, OrdersThereAndBackAreFound) {
  for (const auto& [order, asked] :
       {std::pair(Order::serpentine_rows, 0.62), std::pair(Order::serpentine_columns, 0.78)}) {
    const Counts counts = count(order, Cause::direction_hysteresis, kSets, 7100);
    EXPECT_GT(probability_of_at_least(kSets - counts.right, kSets, 1.0 - asked), 1e-3)
        << word(order) << ": " << counts.right << " of " << kSets << ", seeds from 7100";
    // Fails in 96 of 100 runs where one in ten is wrong.
    EXPECT_GT(probability_of_at_least(counts.wrong, kSets, 0.02), 1e-3)
        << word(order) << ": " << counts.wrong << " of " << kSets << ", seeds from 7100";
  }
}

TEST(Sealed, NoOrderIsFoundForRandomVisits) {
  const Counts counts = count(Order::random, Cause::direction_hysteresis, kSets, 7400);
  EXPECT_GT(probability_of_at_least(counts.wrong, kSets, 0.02), 1e-3) << counts.wrong << ", seeds from 7400";
}

TEST(Sealed, NoOrderIsFoundWithoutAnEffectOfTheVisits) {
  const Counts counts = count(Order::serpentine_columns, std::nullopt, kSets, 7600);
  const int found = counts.right + counts.wrong;
  EXPECT_GT(probability_of_at_least(found, kSets, 0.02), 1e-3) << found << ", seeds from 7600";
}

TEST(Sealed, CausesFollowTheFoundOrder) {
  generator::Recipe recipe;
  recipe.points = 60;
  recipe.order = Order::serpentine_columns;
  recipe.cause = Cause::direction_hysteresis;
  recipe.delta = 14.0;
  grid::MeasuredGrid grid = without_numbers(generator::draw_set(recipe, 7800));
  grid::diagnosis::DiagnosisOptions options;
  options.improvement = options.next_measurements = options.stability = false;
  const auto d = grid::diagnosis::diagnose(grid, options);
  ASSERT_TRUE(d) << d.error().sentence();
  ASSERT_TRUE(d->visiting_order);
  EXPECT_FALSE(d->visiting_order->order.rows);
  EXPECT_TRUE(d->visiting_order->order.serpentine);
  ASSERT_FALSE(d->causes.empty()) << d->sentence;
  EXPECT_EQ(d->causes.front().cause.effect->id, "direction_hysteresis");
  EXPECT_TRUE(d->causes.front().order_assumed);
  EXPECT_THAT(d->notes.front(), testing::HasSubstr("there and back in columns"));
}

}  // namespace
}  // namespace visits
}  // namespace chaintrue::sealed
