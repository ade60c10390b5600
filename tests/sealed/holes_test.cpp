// SPDX-License-Identifier: GPL-3.0-or-later
// Holes cut by the hidden machine, which shares no line with the product: where it comes to rest
// with the lengths that the controller paid out, measured with a tape, and diagnosed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/random.hpp"
#include "grid/observation/tape_distances.hpp"
#include "sealed/posed.hpp"
#include "tests/holes/hole_sets.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::TrueMachine;
using generator::Vec2;
using generator::Where;

Eigen::Vector2d reading(const TrueMachine& machine, std::span<const Hidden> effects, Vec2 place) {
  const std::vector<generator::Visit> visit = {{place, 0}};
  const auto rest = generator::rests(generator::altered(machine, effects), visit);
  EXPECT_TRUE(rest);
  const auto lengths = generator::readings(machine, effects, visit, *rest);
  return {lengths.front()[0], lengths.front()[1]};
}

/// Where these lengths are read: Newton's method with differences of half a millimetre.
Vec2 place_of(const TrueMachine& machine,
              std::span<const Hidden> effects,
              const model::ChainLengths& paid_out,
              Vec2 at) {
  constexpr double kStepMm = 0.5;
  constexpr int kMost = 20;
  constexpr double kThereMm = 1e-3;  // against a noise of 0.3 mm
  const Eigen::Vector2d wanted(paid_out.left_mm, paid_out.right_mm);
  for (int step = 0; step < kMost; ++step) {
    const Eigen::Vector2d here = reading(machine, effects, at);
    if ((wanted - here).norm() < kThereMm) break;
    Eigen::Matrix2d slope;
    slope.col(0) = (reading(machine, effects, {at.x + kStepMm, at.y}) - here) / kStepMm;
    slope.col(1) = (reading(machine, effects, {at.x, at.y + kStepMm}) - here) / kStepMm;
    const Eigen::Vector2d move = slope.inverse() * (wanted - here);
    at = {at.x + move.x(), at.y + move.y()};
  }
  EXPECT_LT((wanted - reading(machine, effects, at)).norm(), 0.05);
  return at;
}

/// Motors off by 1.5 mm and zeros by 0.5 mm, one sigma; stated 3 and 1.
grid::MeasuredHoles hidden_holes(const std::vector<Hidden>& effects, std::uint64_t seed) {
  grid::MeasuredHoles set = testing_support::nine_holes();
  generator::Dice dice(seed, "holes");
  TrueMachine truth;
  for (Vec2& axis : truth.axis) {
    axis.x += 1.5 * dice.normal();
    axis.y += 1.5 * dice.normal();
  }
  for (double& zero : truth.chain_zero_mm) zero = 0.5 * dice.normal();
  const auto distances = grid::observation::TapeDistances::in_given_order(set);
  std::vector<Vec2> places;
  for (std::size_t i = 0; i < set.holes.size(); ++i) {
    const model::BedPoint& near = set.holes[i].commanded;
    Vec2 place = place_of(truth, effects, distances->places()[i].lengths, {near.x_mm, near.y_mm});
    place.x += set.hole_sigma_mm * dice.normal();
    place.y += set.hole_sigma_mm * dice.normal();
    places.push_back(place);
  }
  for (grid::HoleDistance& distance : set.distances) {
    const Vec2& a = places[distance.from];
    const Vec2& b = places[distance.to];
    distance.distance_mm = std::hypot(a.x - b.x, a.y - b.y) + set.tape.sigma_mm * dice.normal();
  }
  return set;
}

grid::diagnosis::Diagnosis opened(const grid::MeasuredHoles& set) {
  grid::diagnosis::DiagnosisOptions options;
  options.gain = options.next_measurements = options.stability = false;
  const auto found = grid::diagnosis::diagnose(set, options);
  EXPECT_TRUE(found) << found.error().sentence;
  return *found;
}

TEST(SealedHoles, ALongChainIsNamed) {
  constexpr int kSets = 20;
  int right = 0;
  for (int k = 0; k < kSets; ++k) {
    const auto seed = static_cast<std::uint64_t>(7000 + k);
    SCOPED_TRACE(fmt::format("seed {}", seed));
    const Where side = k % 2 == 0 ? Where::left : Where::right;
    const std::vector<Hidden> hidden = {{Cause::chain_pitch_error, side, 0.0015, 0.0}};
    right += led_by(opened(hidden_holes(hidden, seed)),
                    fmt::format("chain_pitch_error:{}", generator::word(side)));
  }
  // Eight units of noise: as a grid's causes of that strength.
  EXPECT_GE(right, fewest(kSets, 0.95));
}

TEST(SealedHoles, NothingHiddenIsNotNamed) {
  constexpr int kSets = 40;
  int named = 0;
  for (int k = 0; k < kSets; ++k) {
    const auto seed = static_cast<std::uint64_t>(8000 + k);
    SCOPED_TRACE(fmt::format("seed {}", seed));
    named += names_any(opened(hidden_holes({}, seed)));
  }
  EXPECT_LE(named, most(kSets, 0.01));
}

}  // namespace
}  // namespace chaintrue::sealed
