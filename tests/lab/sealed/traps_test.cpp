// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Misleading sets.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "generator/hidden/strength.hpp"
#include "grid/files/grid_file.hpp"
#include "sealed/judge/binomial.hpp"
#include "sealed/posed.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::Order;
using generator::Where;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;
using testing::Contains;
using testing::HasSubstr;

bool not_testable(const Diagnosis& found, const std::string& effect) {
  return std::any_of(found.not_testable.begin(), found.not_testable.end(), [&](const auto& no) {
    return no.cause.effect->id == effect;
  });
}

// 1 mm on the wheel's radius: motors and zeros absorb all of it except a delta of 1.
TEST(Traps, EffectsTheSettingsAbsorbAreBoundedNotNamed) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto set = posed({{Cause::sprocket_radius, Where::nowhere, 1.0, 0.0}}, Order::rows, seed);
    ASSERT_LT(set.answer.delta.front(), 1.5);
    const Diagnosis found = diagnosed(read(set));
    EXPECT_EQ(found.verdict, Verdict::nothing_found) << found.sentence;
    const auto bound = std::find_if(found.bounds.begin(), found.bounds.end(), [](const auto& b) {
      return b.cause.effect->id == "sprocket_radius";
    });
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
    const bool off = std::any_of(found.settings.begin(), found.settings.end(), [](const auto& s) {
      return s.off && s.setting == model::Setting::motor_left_x_mm;
    });
    EXPECT_TRUE(off);
  }
}

// The second effect cancels the first; alone, either would be named.
TEST(Traps, CancellingEffectsAreNotNamed) {
  const auto blank = posed({}, Order::random, 3);
  const auto yardstick =
      generator::Yardstick::make(blank.machine.truth(), blank.machine.visits(), {}, {});
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

// One reading a link too long: a miscount or a bad point, not an effect of the machine.
TEST(Traps, OneBadPointIsNoMachineCause) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto set =
        posed({{Cause::link_miscount, Where::left, 1.0, 11.0}}, Order::serpentine_columns, seed);
    const Diagnosis found = diagnosed(read(set));
    std::vector<std::size_t> bad;
    for (const auto& b : found.outliers) bad.push_back(b.index);
    EXPECT_THAT(bad, Contains(11u));
    if (found.verdict != Verdict::outliers) {
      EXPECT_TRUE(led_by(found, "link_miscount:left")) << found.sentence;
    }
    EXPECT_TRUE(found.extended_machine.effects.empty());
  }
}

// Columns visited from left to right: time increases with x. Drift of the right chain then
// resembles that chain's pitch; in random order it is unique.
TEST(Traps, ReportDriftInARaster) {
  const std::vector<Hidden> drift{{Cause::drift, Where::right, 0.06, 0.0}};
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const Diagnosis raster = diagnosed(read(posed(drift, Order::columns, seed)));
    EXPECT_THAT(ids(raster), Contains("drift:right")) << raster.sentence;
    const Diagnosis random = diagnosed(read(posed(drift, Order::random, seed)));
    EXPECT_EQ(random.verdict, Verdict::named) << random.sentence;
    EXPECT_TRUE(led_by(random, "drift:right"));
  }
}

// A serpentine order shows; a random one does not.
TEST(Traps, HysteresisIsTestableIfTheReadingsShowTheOrder) {
  const std::vector<Hidden> friction{{Cause::direction_hysteresis, Where::both, 0.8, 0.0}};
  const auto without_order = [&](Order order) {
    grid::MeasuredGrid grid = read(posed(friction, order, 2));
    EXPECT_TRUE(led_by(diagnosed(grid), "direction_hysteresis:both"));
    for (auto& p : grid.points) p.order.reset();
    return diagnosed(grid);
  };
  const Diagnosis there_and_back = without_order(Order::serpentine_rows);
  ASSERT_TRUE(there_and_back.visiting_order);
  EXPECT_TRUE(there_and_back.visiting_order->order.rows);
  EXPECT_TRUE(led_by(there_and_back, "direction_hysteresis:both"));
  const Diagnosis found = without_order(Order::random);
  EXPECT_FALSE(found.visiting_order);
  for (const char* effect : {"direction_hysteresis", "drift", "tooth_skip"}) {
    EXPECT_TRUE(not_testable(found, effect)) << effect;
    for (const auto& id : ids(found)) EXPECT_THAT(id, testing::Not(HasSubstr(effect)));
    for (const auto& b : found.bounds) EXPECT_NE(b.cause.effect->id, effect);
  }
}

TEST(Traps, SwappedPointsAreTheTwoBadOnes) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    grid::MeasuredGrid grid = read(posed({}, Order::serpentine_rows, seed));
    std::swap(grid.points[7].lengths, grid.points[20].lengths);
    const Diagnosis found = diagnosed(grid);
    EXPECT_EQ(found.verdict, Verdict::outliers) << found.sentence;
    std::vector<std::size_t> bad;
    for (const auto& b : found.outliers) bad.push_back(b.index);
    EXPECT_THAT(bad, testing::UnorderedElementsAre(7u, 20u));
  }
}

// Effects of the paper are corrected in the data. A machine with the tape's error would cut it into
// every part.
TEST(Traps, ATapeErrorDoesNotEnterTheMachine) {
  for (const Where where : {Where::x, Where::y}) {
    const double scale = where == Where::x ? 0.0016 : 0.004;
    const auto set = posed({{Cause::tape_scale, where, scale, 0.0}}, Order::columns, 5);
    SCOPED_TRACE("delta " + std::to_string(set.answer.delta.front()));
    grid::diagnosis::DiagnosisOptions how;
    how.next_measurements = false;
    const auto found = grid::diagnosis::diagnose(read(set), how);
    ASSERT_TRUE(found);
    EXPECT_TRUE(led_by(*found, "tape_scale:" + std::string(word(where)))) << found->sentence;
    EXPECT_TRUE(found->extended_machine.effects.empty());
    ASSERT_EQ(found->data_corrections.size(), 1u);
    EXPECT_EQ(found->data_corrections.front().effect, "tape_scale");
    EXPECT_NEAR(found->data_corrections.front().parameters.at("scale"), scale, 0.3 * scale);
  }
}

// An effect too small to be detected is below its bound of 95 %.
TEST(Traps, BoundsHold) {
  int held = 0, bounded = 0;
  for (const auto& card : generator::cards()) {
    if (card.whole() || card.place != generator::Place::none || card.sides.size() > 1) continue;
    const auto blank = posed({}, Order::random, 6);
    const auto yardstick =
        generator::Yardstick::make(blank.machine.truth(), blank.machine.visits(), {}, {});
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
