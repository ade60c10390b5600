// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Misleading sets; and changes of the input that must not change a diagnosis, or must change it in a known way.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "generator/hidden/strength.hpp"
#include "grid/files/grid_file.hpp"
#include "model/effects/catalogue.hpp"
#include "sealed/judge/binomial.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::Mix;
using generator::Order;
using generator::Where;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;

/// A set with exactly these effects; regular grid, six repeats, usual noise.
generator::SealedSet posed(std::vector<Hidden> effects, Order order, std::uint64_t seed) {
  generator::Recipe recipe;
  recipe.kind = Mix::nothing;
  recipe.order = order;
  recipe.exactly = std::move(effects);
  return generator::draw_set(recipe, seed);
}

grid::MeasuredGrid read(const generator::SealedSet& set) {
  return grid::files::parse_grid(set.grid_text, "sealed.json").grid;
}

Diagnosis diagnosed(const grid::MeasuredGrid& grid) {
  return grid::diagnosis::diagnose(grid, verdict_alone()).value();
}

std::string first_name(const Diagnosis& found) {
  return named_causes(found).front().members.front();
}

bool names_any(const Diagnosis& found) { return Trial(found).names_something(); }

generator::SealedSet drawn(std::uint64_t seed) {
  generator::Recipe recipe;
  recipe.kind = Mix::single;
  return generator::draw_set(recipe, seed);
}

std::string mirrored(std::string id) {
  const auto colon = id.find(':');
  const std::string side = id.substr(colon + 1);
  if (side == "left") return id.substr(0, colon) + ":right";
  if (side == "right") return id.substr(0, colon) + ":left";
  return id;
}

// In the mirror image left and right are exchanged and the rest is equal. Searches over places from
// one end may end a step apart; the verdict and the names must be equal.
TEST(Metamorphic, TheMirrorImageHasTheMirroredCause) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto grid = read(drawn(seed));
    const Diagnosis before = diagnosed(grid);
    for (auto& p : grid.points) {
      p.mark.x_mm = -p.mark.x_mm;
      std::swap(p.lengths->left_mm, p.lengths->right_mm);
    }
    auto& motors = grid.machine->motors;
    std::swap(motors.left, motors.right);
    motors.left.x_mm = -motors.left.x_mm;
    motors.right.x_mm = -motors.right.x_mm;
    std::swap(grid.machine->chain_zero.left_mm, grid.machine->chain_zero.right_mm);
    const Diagnosis after = diagnosed(grid);
    EXPECT_EQ(before.verdict, after.verdict);
    ASSERT_EQ(before.causes.size(), after.causes.size());
    ASSERT_FALSE(before.causes.empty());
    EXPECT_EQ(mirrored(first_name(before)), first_name(after));
    EXPECT_NEAR(before.causes.front().probability, after.causes.front().probability, 0.02);
  }
}

// With the named causes in the model, nothing remains to be named.
TEST(Metamorphic, AddingTheNamedCauseRemovesIt) {
  for (std::uint64_t seed = 11; seed <= 15; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    auto grid = read(drawn(seed));
    const Diagnosis found = diagnosed(grid);
    if (found.verdict != Verdict::named) continue;
    model::AppliedEffect named{std::string(found.causes.front().cause.effect->id),
                               std::string(model::effects::name(found.causes.front().cause.side)),
                               {}};
    for (const auto& p : found.causes.front().parameters) named.parameters[p.parameter] = p.value;
    grid.machine->effects.push_back(named);
    const Diagnosis again = diagnosed(grid);
    EXPECT_FALSE(names_any(again)) << again.sentence;
  }
}

bool not_testable(const Diagnosis& found, const std::string& effect) {
  return std::ranges::any_of(found.not_testable,
                             [&](const auto& no) { return no.cause.effect->id == effect; });
}

// 1 mm on the wheel's radius: motors and zeros absorb all of it except a delta of 1.
TEST(Traps, EffectsTheSettingsAbsorbAreBoundedNotNamed) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto set = posed({{Cause::sprocket_radius, Where::nowhere, 1.0, 0.0}}, Order::rows, seed);
    ASSERT_LT(set.answer.delta.front(), 1.5);
    const Diagnosis found = diagnosed(read(set));
    EXPECT_EQ(found.verdict, Verdict::nothing_found) << found.sentence;
    const auto bound = std::ranges::find_if(
        found.bounds, [](const auto& b) { return b.cause.effect->id == "sprocket_radius"; });
    if (bound != found.bounds.end()) {
      EXPECT_GT(bound->upper_95, 1.0);
    } else {
      EXPECT_TRUE(not_testable(found, "sprocket_radius"));
    }
  }
}

// The left motor is 15 mm from its taped position, five of its sigmas: an error of a setting, not a
// cause.
TEST(Traps, ABadSettingIsNamedAsASetting) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    grid::MeasuredGrid grid = read(posed({}, Order::serpentine_rows, seed));
    grid.machine->motors.left.x_mm -= 15.0;
    const Diagnosis found = diagnosed(grid);
    EXPECT_FALSE(names_any(found)) << found.sentence;
    const bool off = std::ranges::any_of(found.settings, [](const auto& s) {
      return s.off && s.setting == model::Setting::motor_left_x_mm;
    });
    EXPECT_TRUE(off);
  }
}

/// The usual size of patterns over random visits, with no cause acting.
auto yardstick_of(std::uint64_t seed) {
  const auto blank = posed({}, Order::random, seed);
  return generator::Yardstick::make(blank.machine.truth(), blank.machine.visits(), {}, {});
}

// The second effect cancels the first; alone, either would be named.
TEST(Traps, CancellingEffectsAreNotNamed) {
  const auto yardstick = yardstick_of(3);
  const Hidden first[] = {{Cause::tape_scale, Where::both, 0.001, 0.0}};
  // Both chains, and the tape along both axes: indistinguishable with data of this kind.
  const Hidden second[] = {{Cause::chain_pitch_error, Where::both, 0.001, 0.0}};
  const auto a = yardstick->signature(first), b = yardstick->signature(second);
  Hidden answer = second[0];
  answer.size *= -a->dot(*b) / b->squaredNorm();
  const Hidden both[] = {first[0], answer};
  ASSERT_GT(a->norm(), 8.0);
  ASSERT_LT(yardstick->signature(both)->norm(), 1.0);
  const Diagnosis found = diagnosed(read(posed({both[0], both[1]}, Order::random, 3)));
  EXPECT_EQ(found.verdict, Verdict::nothing_found) << found.sentence;
}

// An effect too small to be detected is below its bound of 95 %.
TEST(Traps, BoundsHold) {
  int held = 0, bounded = 0;
  for (const auto& card : generator::cards()) {
    if (card.whole() || card.place != generator::Place::none || card.sides.size() > 1) continue;
    const auto yardstick = yardstick_of(6);
    Hidden one[] = {{card.cause, Where::nowhere, card.usual, 0.0}};
    one[0].size *= 2.0 / yardstick->signature(one)->norm();
    if (one[0].size > card.upper) continue;
    for (std::uint64_t seed = 6; seed < 26; ++seed) {
      const Diagnosis found = diagnosed(read(posed({one[0]}, Order::random, seed)));
      for (const auto& b : found.bounds) {
        if (b.cause.effect->id != card.id || b.parameter != card.size_name) continue;
        ++bounded;
        held += b.upper_95 >= std::abs(one[0].size) ? 1 : 0;
        EXPECT_GT(b.upper_95, 0.0);
      }
    }
  }
  // Fails by chance once in a thousand runs, and in 99 of 100 where bounds hold in 80 % of 140 sets.
  EXPECT_GT(bounded, 100) << "seeds 6 to 25";
  EXPECT_GT(probability_of_at_least(bounded - held, bounded, 0.05), 1e-3)
      << held << " of " << bounded << ", seeds 6 to 25";
}

}  // namespace
}  // namespace chaintrue::sealed
