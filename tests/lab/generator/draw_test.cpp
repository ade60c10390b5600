// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A sealed set agrees with its recipe: strengths, bounds, noise, gross errors, orders; and its
/// text is a valid grid file.
#include "generator/hidden/draw.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string>

#include "generator/hidden/oracle.hpp"
#include "grid/files/grid_file.hpp"

namespace chaintrue::generator {
namespace {

Recipe recipe(Mix kind, int points = 28) {
  Recipe r;
  r.kind = kind;
  r.points = points;
  return r;
}

TEST(Draw, SameSeedSameBytes) {
  for (const Mix mix : {Mix::single, Mix::unlisted, Mix::bad_points_and_effect}) {
    EXPECT_EQ(draw_set(recipe(mix), 7).grid_text, draw_set(recipe(mix), 7).grid_text);
    EXPECT_NE(draw_set(recipe(mix), 7).grid_text, draw_set(recipe(mix), 8).grid_text);
  }
}

TEST(Draw, StrengthsAndSizesAreInRangeAndEffectsEven) {
  std::map<Cause, int> found;
  std::set<Order> orders;
  constexpr int kSets = 480;
  for (std::uint64_t seed = 1; seed <= kSets; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SealedSet set = draw_set(recipe(Mix::single), seed);
    ASSERT_EQ(set.answer.hidden.size(), 1u);
    const Hidden& h = set.answer.hidden.front();
    const CauseCard& c = card(h.cause);
    ++found[h.cause];
    orders.insert(set.answer.order);
    EXPECT_GE(h.size, c.lower);
    EXPECT_LE(h.size, c.upper);
    EXPECT_GT(set.answer.delta.front(), 5.99);  // searched to 1e-3
    EXPECT_LT(set.answer.delta.front(), 22.03);
    if (c.whole()) {
      EXPECT_EQ(h.size, std::round(h.size));
    }
  }
  EXPECT_EQ(orders.size(), kOrders);
  for (const CauseCard& c : cards()) {
    // The settings absorb nearly all of it: see SprocketRadiusStaysBelowSix.
    if (c.cause == Cause::sprocket_radius) continue;
    // Asked for by name alone: the frozen sets are drawn from the others.
    if (c.cause == Cause::zero_shift) continue;
    // 30 expected each, sigma 5.3; effects that cannot have the strength are replaced by others.
    EXPECT_GT(found[c.cause], 9) << c.id;
    EXPECT_LT(found[c.cause], 52) << c.id;
  }
}

// 3 mm on a radius of 10 mm, absorbed by zeros and motors except for a delta of 3: no draw of the
// mix can have it, and no data of this kind can identify it.
TEST(Draw, SprocketRadiusStaysBelowSix) {
  for (const int points : {28, 60, 117}) {
    const SealedSet set = draw_set(recipe(Mix::nothing, points), 1);
    const auto y = Yardstick::make(set.machine.truth(), set.machine.visits(), {}, {});
    for (const double size : {-3.0, 3.0}) {
      const Hidden one[] = {{Cause::sprocket_radius, Where::nowhere, size, 0.0}};
      EXPECT_LT(y->signature(one)->norm(), 6.0);
    }
  }
}

TEST(Draw, TextsAreGridFilesWithoutAFault) {
  for (const int points : {28, 60, 117}) {
    for (const Mix mix : {Mix::single, Mix::nothing, Mix::heavy, Mix::wrong_noise, Mix::no_order}) {
      SCOPED_TRACE(std::string(word(mix)));
      const SealedSet set = draw_set(recipe(mix, points), 11);
      const auto read = grid::files::parse_grid(set.grid_text, "sealed.json");
      ASSERT_EQ(read.grid.points.size(), static_cast<std::size_t>(points) + 6);
      ASSERT_TRUE(read.grid.machine && read.grid.noise);
      EXPECT_EQ(read.grid.noise->dof, 12.0);
      EXPECT_EQ(read.grid.machine->uncertainty.motor_position_mm, 3.0);
      for (const auto& p : read.grid.points) EXPECT_EQ(p.order.has_value(), mix != Mix::no_order);
    }
  }
}

// Written less exact numbers are noise of the stated size.
TEST(Draw, NoiseHasTheListedSize) {
  for (const Mix mix : {Mix::nothing, Mix::heavy}) {
    double length = 0.0, position = 0.0;
    int count = 0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const SealedSet set = draw_set(recipe(mix, 117), seed);
      const auto exact = set.machine.exact(set.machine.visits());
      ASSERT_TRUE(exact);
      for (std::size_t i = 0; i < set.notes.size(); ++i) {
        const Vec2 p = set.machine.visits()[i].place;
        length += std::pow(set.notes[i].lengths[0] - (*exact)[i][0], 2) +
                  std::pow(set.notes[i].lengths[1] - (*exact)[i][1], 2);
        position += std::pow(set.notes[i].mark.x - p.x, 2) + std::pow(set.notes[i].mark.y - p.y, 2);
        count += 2;
      }
    }
    // 4920 numbers: one sigma 1 %; heavy tails have an infinite fourth moment, so more.
    const double tolerance = mix == Mix::heavy ? 0.15 : 0.04;
    EXPECT_NEAR(std::sqrt(length / count), 0.2, 0.2 * tolerance);
    EXPECT_NEAR(std::sqrt(position / count), 0.3, 0.3 * tolerance);
  }
}

TEST(Draw, CausesOfAPairDifferAndAreListed) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const SealedSet set = draw_set(recipe(Mix::two), seed);
    ASSERT_EQ(set.answer.hidden.size(), 2u);
    EXPECT_NE(set.answer.hidden[0].cause, set.answer.hidden[1].cause);
    const auto y = Yardstick::make(set.machine.truth(), set.machine.visits(), {}, {});
    const Hidden a[] = {set.answer.hidden[0]}, b[] = {set.answer.hidden[1]};
    const auto sa = y->signature(a), sb = y->signature(b);
    EXPECT_LT(std::abs(sa->dot(*sb)) / (sa->norm() * sb->norm()), 0.85);
  }
}

TEST(Draw, UnlistedLeavesAtLeastTen) {
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const SealedSet set = draw_set(recipe(Mix::unlisted), seed);
    ASSERT_TRUE(set.answer.unlisted);
    EXPECT_GE(set.answer.left_over_delta, 10.0);
    EXPECT_LE(set.answer.left_over_delta, 20.0);
    EXPECT_GE(set.answer.whole_delta, set.answer.left_over_delta);
  }
}

TEST(Draw, ATenthOfThePointsIsBad) {
  const SealedSet set = draw_set(recipe(Mix::bad_points, 60), 3);
  EXPECT_EQ(set.answer.bad_points.size(), 7u);
}

// Chi-square of the oracle's fit: the number of readings less unknowns, with the settings' priors
// as data.
TEST(Oracle, LeavesNoiseBehind) {
  double sum = 0.0, expected = 0.0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const SealedSet set = draw_set(recipe(Mix::single), seed);
    Record record;
    record.notes = set.notes;
    record.noise = set.noise;
    const auto fitted = fit_given(set.machine, set.answer.hidden, record);
    ASSERT_TRUE(fitted);
    std::vector<Vec2> marks;
    std::vector<int> numbers;
    for (const auto& note : set.notes) {
      marks.push_back(note.mark);
      numbers.push_back(note.number);
    }
    const auto predicted = fitted->predict(marks, numbers);
    const auto y = Yardstick::make(set.machine.truth(), set.machine.visits(), {}, {});
    std::vector<Lengths> left(marks.size());
    for (std::size_t i = 0; i < marks.size(); ++i) {
      for (std::size_t c = 0; c < 2; ++c) left[i][c] = set.notes[i].lengths[c] - (*predicted)[i][c];
    }
    sum += y->signature_of_lengths(left).squaredNorm();
    expected += 2.0 * static_cast<double>(marks.size()) - 7.0;
  }
  // About 730 degrees of freedom: one sigma is sqrt(2 / 730) = 5 %.
  EXPECT_NEAR(sum / expected, 1.0, 0.15);
}

// After the session: visit numbers continue, and readings without noise are exact.
TEST(HiddenMachine, MeasuresAgainReproducibly) {
  SealedSet set = draw_set(recipe(Mix::single), 5);
  const int last = set.machine.visits().back().number;
  Dice dice(1, "again");
  const auto note = set.machine.measure({100.0, 200.0}, {0.0, 0.0}, dice);
  ASSERT_TRUE(note);
  EXPECT_EQ(note->number, last + 1);
  EXPECT_EQ(note->mark.x, 100.0);
  const auto exact = set.machine.exact(set.machine.visits());
  EXPECT_EQ(note->lengths, exact->back());
  EXPECT_TRUE(set.machine.read("motor_spacing_mm", "", dice));
  EXPECT_FALSE(set.machine.read("colour", "", dice));
}

TEST(Draw, PatternsAndCausesFollowTheRules) {
  for (const Mix mix : {Mix::alongside, Mix::two_alongside, Mix::pattern, Mix::near}) {
    for (const PatternGroup group :
         {PatternGroup::smooth, PatternGroup::short_scale, PatternGroup::other}) {
      Recipe own = recipe(mix, 60);
      own.patterns = group;
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(std::string(word(mix)) + " seed " + std::to_string(seed));
        const SealedSet set = draw_set(own, seed);
        ASSERT_TRUE(set.answer.pattern);
        const SizedPattern& p = *set.answer.pattern;
        EXPECT_GE(p.delta, 6.0);
        EXPECT_EQ(set.answer.hidden.size(), mix == Mix::alongside       ? 1U
                                            : mix == Mix::two_alongside ? 2U
                                                                     : 0U);
        EXPECT_NEAR(std::hypot(p.pattern.entry[0], p.pattern.entry[1]), 1.0, 1e-12);  // rounding
        if (mix == Mix::near) {
          EXPECT_GE(p.rho, 0.9);
          EXPECT_LE(p.rho, 0.98);
        } else {
          EXPECT_LT(p.rho, 0.5);
        }
      }
    }
  }
}

}  // namespace
}  // namespace chaintrue::generator
