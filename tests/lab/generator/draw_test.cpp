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
    // The settings absorb nearly all of it.
    if (c.cause == Cause::sprocket_radius) continue;
    // Asked for by name alone: the frozen sets are drawn from the others.
    if (c.cause == Cause::zero_shift) continue;
    // 30 expected each, sigma 5.3; effects that cannot have the strength are replaced by others.
    EXPECT_GT(found[c.cause], 9) << c.id;
    EXPECT_LT(found[c.cause], 52) << c.id;
  }
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
