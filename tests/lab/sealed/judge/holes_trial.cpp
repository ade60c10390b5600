// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/holes_trial.hpp"

#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>

#include "generator/hidden/effects.hpp"
#include "generator/hidden/random.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/observation/tape_distances.hpp"

namespace chaintrue::sealed {
namespace {

using generator::Cause;
using generator::Hidden;
using generator::TrueMachine;
using generator::Vec2;
using generator::Where;

constexpr double kElongation = 0.0015;

Eigen::Vector2d reading(const generator::HiddenMachine& machine, Vec2 place) {
  const std::vector<generator::Visit> visit = {{place, 0}};
  const auto lengths = machine.exact(visit);
  if (!lengths)
    throw std::runtime_error("hidden_holes: the machine cannot reach a place near a hole");
  return {lengths->front()[0], lengths->front()[1]};
}

}  // namespace

const grid::MeasuredHoles& nine_holes() {
  static const grid::MeasuredHoles set =
      grid::files::read(grid::files::parse_holes,
                        std::string(CHAINTRUE_FIXTURES) + "/holes/nine_holes.json")
          .holes;
  return set;
}

// Newton's method with differences of half a millimetre.
Vec2 place_reached(const generator::HiddenMachine& machine, const model::ChainLengths& paid_out,
                   Vec2 at) {
  constexpr double kStepMm = 0.5;
  constexpr int kMost = 20;
  constexpr double kThereMm = 1e-3;  // compared with a noise of 0.3 mm
  constexpr double kFarMm = 0.05;    // a significant part of that noise
  const Eigen::Vector2d wanted(paid_out.left_mm, paid_out.right_mm);
  for (int step = 0; step < kMost; ++step) {
    const Eigen::Vector2d here = reading(machine, at);
    if ((wanted - here).norm() < kThereMm) break;
    Eigen::Matrix2d slope;
    slope.col(0) = (reading(machine, {at.x + kStepMm, at.y}) - here) / kStepMm;
    slope.col(1) = (reading(machine, {at.x, at.y + kStepMm}) - here) / kStepMm;
    const Eigen::Vector2d move = slope.inverse() * (wanted - here);
    at = {at.x + move.x(), at.y + move.y()};
  }
  if (!((wanted - reading(machine, at)).norm() < kFarMm)) {
    throw std::runtime_error("place_reached: no place has the lengths that were paid out");
  }
  return at;
}

CutHoles cut_holes(const std::vector<Hidden>& effects, std::uint64_t seed) {
  grid::MeasuredHoles set = nine_holes();
  generator::Dice dice(seed, "holes");
  const TrueMachine truth = generator::with_settings_off({}, 1.0, dice);
  const auto distances = grid::observation::TapeDistances::in_given_order(set);
  generator::HiddenMachine machine(TrueMachine{}, truth, effects);
  std::vector<Vec2> places;
  std::vector<generator::Visit> visits;
  for (std::size_t i = 0; i < set.holes.size(); ++i) {
    const model::BedPoint& near = set.holes[i].commanded;
    Vec2 place = place_reached(machine, distances->places()[i].lengths, {near.x_mm, near.y_mm});
    visits.push_back({place, static_cast<int>(i)});
    place.x += set.hole_sigma_mm * dice.normal();
    place.y += set.hole_sigma_mm * dice.normal();
    places.push_back(place);
  }
  for (grid::HoleDistance& distance : set.distances) {
    const Vec2& a = places[distance.from];
    const Vec2& b = places[distance.to];
    distance.distance_mm = std::hypot(a.x - b.x, a.y - b.y) + set.tape.sigma_mm * dice.normal();
  }
  machine.went_to(std::move(visits));
  return {std::move(set), std::move(machine)};
}

Outcome run_holes_trial(const std::string& kind, bool long_chain, std::uint64_t seed) {
  std::vector<Hidden> hidden;
  if (long_chain)
    hidden.push_back(
        {Cause::chain_pitch_error, seed % 2 == 0 ? Where::left : Where::right, kElongation, 0.0});
  const grid::MeasuredHoles set = cut_holes(hidden, seed).set;
  const auto found = grid::diagnosis::diagnose(set, verdict_alone());
  Trial trial(found ? *found : grid::diagnosis::Diagnosis{});
  for (const Hidden& own : hidden) trial.hidden.push_back(id_of(own));
  Outcome outcome = outcome_of(kind, seed, trial);
  outcome.points = static_cast<int>(set.distances.size());
  if (!found) outcome.fail();
  return outcome;
}

}  // namespace chaintrue::sealed
