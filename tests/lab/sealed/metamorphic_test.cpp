// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Changes of the input that must not change a diagnosis, or must change it in a known way.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "model/effects/catalogue.hpp"
#include "model/reading_model.hpp"
#include "sealed/posed.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::Mix;
using generator::Order;
using generator::Where;
using grid::diagnosis::Diagnosis;
using grid::diagnosis::Verdict;

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
    EXPECT_EQ(mirrored(ids(before).front()), ids(after).front());
    EXPECT_NEAR(before.causes.front().probability, after.causes.front().probability, 0.02);
  }
}

// Twice the noise and twice all deviations from the stated machine: the same in units of noise.
TEST(Metamorphic, TwiceTheNoiseAndTwiceTheErrorIsTheSame) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const auto set = drawn(seed);
    auto grid = read(set);
    const Diagnosis before = diagnosed(grid);
    const model::ReadingModel stated(*grid.machine);
    for (auto& p : grid.points) {
      const auto as_stated = stated.at(model::identity_placement(p.mark));
      ASSERT_TRUE(as_stated);
      p.lengths->left_mm += p.lengths->left_mm - as_stated->lengths.left_mm;
      p.lengths->right_mm += p.lengths->right_mm - as_stated->lengths.right_mm;
    }
    grid.noise->length_mm *= 2.0;
    grid.noise->position_mm *= 2.0;
    grid.machine->uncertainty.motor_position_mm *= 2.0;
    grid.machine->uncertainty.chain_zero_mm *= 2.0;
    // Doubled or paired whole links are excluded.
    if (generator::card(set.answer.hidden.front().cause).whole()) continue;
    const Diagnosis after = diagnosed(grid);
    EXPECT_EQ(before.verdict, after.verdict);
    ASSERT_FALSE(before.causes.empty() || after.causes.empty());
    EXPECT_EQ(ids(before).front(), ids(after).front());
  }
}

// Effects in the machine file are not found again.
TEST(Metamorphic, AModelledEffectIsNotFound) {
  const std::vector<Hidden> known[] = {{{Cause::chain_pitch_error, Where::left, 0.0012, 0.0}},
                                       {{Cause::beam_flex, Where::nowhere, 0.015, 0.0}},
                                       {{Cause::sprocket_eccentricity, Where::right, 1.0, 0.4}},
                                       {{Cause::direction_hysteresis, Where::both, 0.6, 0.0}}};
  for (const auto& effects : known) {
    const Hidden& h = effects.front();
    const auto& card = generator::card(h.cause);
    SCOPED_TRACE(std::string(card.id));
    auto grid = read(posed(effects, Order::random, 8));
    EXPECT_TRUE(led_by(diagnosed(grid), id_of(h)));
    model::AppliedEffect stated{std::string(card.id), std::string(word(h.where)), {}};
    stated.parameters[std::string(card.size_name)] = h.size;
    if (card.place == generator::Place::phase) stated.parameters["phase_rad"] = h.place;
    grid.machine->effects.push_back(stated);
    const Diagnosis found = diagnosed(grid);
    EXPECT_EQ(found.verdict, Verdict::nothing_found) << found.sentence;
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

}  // namespace
}  // namespace chaintrue::sealed
