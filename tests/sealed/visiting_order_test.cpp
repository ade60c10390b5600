// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Orders of visits that nobody wrote down, found from readings of the hidden machine. With CHAINTRUE_LONG set in
/// the environment 200 sets a row, whose counts are printed (docs/diagnosis_rates.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>

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

bool is_long() { return std::getenv("CHAINTRUE_LONG") != nullptr; }

grid::MeasuredGrid without_numbers(const generator::Recipe& recipe, std::uint64_t seed) {
  grid::MeasuredGrid grid =
      grid::files::parse_grid(generator::draw_set(recipe, seed).grid_text, "sealed.json").grid;
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
  int sets = 0;
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
    const auto found = found_in(without_numbers(recipe, first_seed + static_cast<std::uint64_t>(k)));
    ++counts.sets;
    if (!found) continue;
    const VisitingOrder truth = drawn(order);
    EXPECT_FALSE(found->corner_known);  // marks were measured again
    const bool same = found->order.rows == truth.rows && found->order.serpentine == truth.serpentine;
    ++(same && order != Order::random ? counts.right : counts.wrong);
  }
  return counts;
}

/// An order, and how often it is found: the counts of 200 sets. One way along lines a chain is paid out at nearly
/// every mark, so that the order shows in the first marks of the lines alone.
struct Frozen {
  Order order;
  int found = 0;
};

class OfFriction : public testing::TestWithParam<Frozen> {};

// Friction of strength 6 to 22, six marks measured again in between.
TEST_P(OfFriction, TheOrderIsFoundAsOftenAsFrozen) {
  const int sets = is_long() ? 200 : 6;
  const Counts counts = count(GetParam().order, Cause::direction_hysteresis, sets, 7100);
  std::printf("%d right, %d wrong of %d\n", counts.right, counts.wrong, counts.sets);
  EXPECT_LE(rate_bounds_95(GetParam().found, 200).lower, rate_bounds_95(counts.right, counts.sets).upper);
  // One in fifty, or what chance makes of that in so many sets.
  EXPECT_GE(0.02, rate_bounds_95(counts.wrong, counts.sets).lower);
}

INSTANTIATE_TEST_SUITE_P(Sealed,
                         OfFriction,
                         testing::Values(Frozen{Order::rows, 82},
                                         Frozen{Order::columns, 39},
                                         Frozen{Order::serpentine_rows, 137},
                                         Frozen{Order::serpentine_columns, 166}),
                         [](const auto& frozen) { return std::string(word(frozen.param.order)); });

TEST(Sealed, NoOrderIsFoundWhereMarksWereVisitedAtRandom) {
  const Counts counts = count(Order::random, Cause::direction_hysteresis, is_long() ? 200 : 6, 7400);
  std::printf("%d found of %d\n", counts.wrong, counts.sets);
  EXPECT_GE(0.02, rate_bounds_95(counts.wrong, counts.sets).lower);
}

TEST(Sealed, NoOrderIsFoundWhereNothingDependsOnIt) {
  const Counts counts = count(Order::serpentine_columns, std::nullopt, is_long() ? 200 : 6, 7600);
  std::printf("%d found of %d\n", counts.right + counts.wrong, counts.sets);
  EXPECT_GE(0.02, rate_bounds_95(counts.right + counts.wrong, counts.sets).lower);
}

TEST(Sealed, CausesAreOfTheOrderThatWasFound) {
  generator::Recipe recipe;
  recipe.points = 60;
  recipe.order = Order::serpentine_columns;
  recipe.cause = Cause::direction_hysteresis;
  recipe.delta = 14.0;
  grid::MeasuredGrid grid = without_numbers(recipe, 7800);
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
  // The order of the file's rows is of no account.
  std::mt19937 dice(5);
  std::shuffle(grid.points.begin(), grid.points.end(), dice);
  const auto shuffled = grid::diagnosis::diagnose(grid, options);
  ASSERT_TRUE(shuffled && shuffled->visiting_order);
  EXPECT_EQ(shuffled->visiting_order->probability, d->visiting_order->probability);
  EXPECT_EQ(shuffled->sentence, d->sentence);
}

}  // namespace
}  // namespace visits
}  // namespace chaintrue::sealed
