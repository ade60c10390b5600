// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Orders of visits that nobody wrote down, found from readings of the hidden machine. With CHAINTRUE_LONG set in
/// the environment 200 sets a row, whose counts are printed (docs/diagnosis_rates.md).
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
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
  int sets = 0;
  /// Of those whose cause is of strength 7 and more: right ones, and all, by points.
  std::map<int, std::pair<int, int>> strong;
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
    const generator::SealedSet set = generator::draw_set(recipe, first_seed + static_cast<std::uint64_t>(k));
    const auto found = found_in(without_numbers(set));
    ++counts.sets;
    const bool is_strong = cause && set.answer.delta.front() >= 7.0;
    if (is_strong) ++counts.strong[recipe.points].second;
    if (!found) continue;
    const VisitingOrder truth = drawn(order);
    EXPECT_FALSE(found->corner_known);  // marks were measured again
    const bool same = found->order.rows == truth.rows && found->order.serpentine == truth.serpentine;
    const bool is_right = same && order != Order::random;
    ++(is_right ? counts.right : counts.wrong);
    if (is_strong && is_right) ++counts.strong[recipe.points].first;
  }
  return counts;
}

/// An order, and how often it is found: the counts of 200 sets. One way along lines a chain is paid out at nearly
/// every mark, so that the order shows in the first marks of the lines alone.
struct Frozen {
  Order order;
  Cause cause;
  int found = 0;
};

class OfWhatDepends : public testing::TestWithParam<Frozen> {};

// Friction or drift of strength 6 to 22, six marks measured again in between.
TEST_P(OfWhatDepends, TheOrderIsFoundAsOftenAsFrozen) {
  const int sets = is_long() ? 200 : 6;
  const Counts counts = count(GetParam().order, GetParam().cause, sets, 7100);
  std::printf("%d right, %d wrong of %d; of strength 7 and more", counts.right, counts.wrong, counts.sets);
  for (const auto& [points, own] : counts.strong)
    std::printf(", %d points: %d of %d", points, own.first, own.second);
  std::printf("\n");
  EXPECT_LE(rate_bounds_95(GetParam().found, 200).lower, rate_bounds_95(counts.right, counts.sets).upper);
  // One in fifty, or what chance makes of that in so many sets.
  EXPECT_GE(0.02, rate_bounds_95(counts.wrong, counts.sets).lower);
}

INSTANTIATE_TEST_SUITE_P(Sealed,
                         OfWhatDepends,
                         testing::Values(Frozen{Order::rows, Cause::direction_hysteresis, 82},
                                         Frozen{Order::columns, Cause::direction_hysteresis, 39},
                                         Frozen{Order::serpentine_rows, Cause::direction_hysteresis, 137},
                                         Frozen{Order::serpentine_columns, Cause::direction_hysteresis, 166},
                                         Frozen{Order::rows, Cause::drift, 5},
                                         Frozen{Order::serpentine_columns, Cause::drift, 18}),
                         [](const auto& frozen) {
                           return std::string(frozen.param.cause == Cause::drift ? "drift_" : "friction_") +
                                  std::string(word(frozen.param.order));
                         });

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
