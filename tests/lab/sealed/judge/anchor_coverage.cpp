// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/anchor_coverage.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "grid/belts/anchor_fit.hpp"
#include "grid/containers.hpp"
#include "grid/diagnosis/anchors_with_causes.hpp"
#include "grid/random.hpp"
#include "grid/synthetic/simulated_belts.hpp"
#include "model/belts/belt_effects.hpp"

namespace chaintrue::sealed {
namespace {

constexpr std::array kUsual = {UsualCause{},
                               UsualCause{"belt_stretch", "elongation", 0.001, 0.003},
                               UsualCause{"anchor_flex", "give_mm", 0.5, 2.0},
                               UsualCause{"anchor_height", "offset_mm", 10.0, 40.0, true},
                               UsualCause{"belt_scale", "scale", 0.001, 0.003, true},
                               UsualCause{"belt_zero", "offset_mm", 1.0, 5.0, true},
                               UsualCause{"drift", "rate_mm_per_visit", 0.01, 0.05, true},
                               UsualCause{"tooth_skip", "teeth", 1.0, 1.0, true},
                               UsualCause{"zero_shift", "shift_mm", 1.0, 10.0, true},
                               UsualCause{"anchor_moved", "distance_mm", 1.0, 10.0}};

model::BeltMachine frame() {
  model::BeltMachine machine;
  machine.anchors_known = true;
  machine.anchors = {
      {-27.6, 2064.9, 100.0}, {2924.3, 2066.5, 56.0}, {0.0, 0.0, 34.0}, {2953.2, 0.0, 78.0}};
  return machine;
}

/// All four belts together change the scale, which no belt shows, and a frame as a whole no length.
bool shows(const UsualCause& cause, model::effects::EffectSide side) {
  return side != model::effects::EffectSide::all ||
         (cause.effect != "belt_scale" && cause.effect != "anchor_moved");
}

model::AppliedEffect drawn(const UsualCause& cause, int places, grid::Random& random) {
  const model::effects::Effect& effect =
      *model::effects::find_effect(model::belts::belt_effects(), cause.effect);
  std::vector<model::effects::EffectSide> sides;
  for (const auto side : effect.sides) {
    if (shows(cause, side)) sides.push_back(side);
  }
  model::AppliedEffect applied;
  applied.effect = cause.effect;
  applied.side = name(sides.at(random.below(sides.size())));
  const double size = random.uniform(cause.least, cause.most);
  const bool negative = cause.either_sign && random.uniform() < 0.5;
  applied.parameters[std::string(cause.parameter)] = negative ? -size : size;
  for (const auto& parameter : effect.parameters) {
    // Not among the first or last two: such a step is no other than two bad readings.
    if (parameter.name == "first_visit")
      applied.parameters["first_visit"] = std::floor(random.uniform(2.0, places - 2.0));
    if (parameter.name == "direction_rad")
      applied.parameters["direction_rad"] = random.uniform(-std::numbers::pi, std::numbers::pi);
  }
  return applied;
}

}  // namespace

std::span<const UsualCause> usual_causes() { return kUsual; }

Outcome coverage_of(const std::string& effect, std::uint64_t seed, int side) {
  constexpr double kWithin = 1.96;
  const model::BeltMachine truth = frame();
  const grid::belts::AnchorVector true_anchors = grid::belts::anchors_of(truth);
  grid::synthetic::BeltsSpec spec;
  spec.columns = spec.rows = side;
  spec.seed = seed;
  const UsualCause& cause = *grid::find_where(kUsual, grid::having(&UsualCause::effect, effect));
  if (cause.most > 0.0) {
    grid::Random random(seed, effect.size());
    spec.hidden.push_back(drawn(cause, side * side, random));
  }
  const auto belts = grid::synthetic::simulate_belts(truth, truth, spec);
  if (!belts) throw std::logic_error("a session that cannot be simulated");
  const auto fit = grid::diagnosis::fit_with_causes(*belts);
  const auto alone = grid::fit_belts(*belts);
  if (!fit || !alone) throw std::logic_error("a session that cannot be fitted");
  Outcome outcome{.kind = effect, .seed = seed, .points = side * side};
  const auto of = static_cast<double>(fit->coordinates.size());
  for (std::size_t i = 0; i < fit->coordinates.size(); ++i) {
    const auto sigmas = [&](const grid::AnchorCoordinate& c) {
      return std::abs(c.fitted_mm - true_anchors[static_cast<Eigen::Index>(i)]) / c.sigma_mm;
    };
    const double off = sigmas(fit->coordinates[i]);
    outcome.numbers["held"] += (off < kWithin ? 1.0 : 0.0) / of;
    outcome.numbers["held_alone"] += (sigmas(alone->coordinates[i]) < kWithin ? 1.0 : 0.0) / of;
    outcome.numbers["square"] += off * off / of;
  }
  return outcome;
}

}  // namespace chaintrue::sealed
