// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/planning/detectable_effects.hpp"

#include <cmath>
#include <optional>
#include <stdexcept>

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid {
namespace {

/// cos 5 degrees: signatures nearer than this need hundreds of readings to be distinguished.
constexpr double kOneDirection = 0.9962;

/// An effect's secant: the change of the distances at its nominal size.
struct Secant {
  const model::effects::Effect* effect = nullptr;
  model::effects::EffectSide side{};
  Eigen::VectorXd change_mm;
};

struct Pattern {
  DetectableEffect found;
  Eigen::VectorXd white;
};

bool shows_in_distances(const model::effects::Effect& effect) {
  return effect.station != model::effects::Station::paper &&
         !model::effects::depends_on_visit(effect);
}

/// The set linearised about the stated machine.
struct Stated {
  Eigen::MatrixXd covariance;  ///< K
  std::vector<Secant> secants;
};

std::optional<Stated> stated_of(const MeasuredHoles& set) {
  if (!set.machine) throw std::invalid_argument("effects on distances need a machine");
  const auto distances = observation::TapeDistances::in_given_order(set);
  if (!distances) return std::nullopt;
  // Distances between holes do not depend on the sheet's placement; in those to its edges, a shift
  // of the whole must not be mistaken for an effect.
  const observation::Columns columns{.parameters = true, .sheet = true};
  const auto line = distances->linearise({model::ReadingModel(*set.machine), {}}, columns);
  if (!line) return std::nullopt;
  Eigen::VectorXd prior(line->by_setting.cols());
  prior << estimation::stated_knowledge(*set.machine).covariance.diagonal().head(model::kMachineSettings.size()),
      std::pow(observation::kSheetShiftMm, 2), std::pow(observation::kSheetShiftMm, 2), std::pow(observation::kSheetTurnRad, 2);
  Stated stated{observation::marginal_covariance(*line, distances->nuisance_sigma()) +
                    line->by_setting * prior.asDiagonal() * line->by_setting.transpose(),
                {}};
  for (const model::effects::Effect* effect : model::effects::effects_of(*set.machine)) {
    if (!shows_in_distances(*effect)) continue;
    for (const model::effects::EffectSide side : effect->sides) {
      model::Machine machine = *set.machine;
      machine.effects.push_back(
          model::effects::applied(*effect, side, model::effects::nominal_values(*effect)));
      if (!model::effects::problems_of_effects(machine).empty()) continue;
      const auto with = distances->predicted({model::ReadingModel(machine), {}});
      if (with) stated.secants.push_back({effect, side, *with - line->predicted});
    }
  }
  return stated;
}

}  // namespace

std::vector<DetectableEffect> detectable_effects(const MeasuredHoles& set) {
  const auto stated = stated_of(set);
  if (!stated) return {};
  const linear::Cholesky covariance(stated->covariance);
  std::vector<Pattern> patterns;
  for (const Secant& secant : stated->secants) {
    Pattern pattern;
    pattern.found.effect = secant.effect->id;
    pattern.found.side = model::effects::name(secant.side);
    pattern.white = covariance.half_solve(secant.change_mm);
    pattern.found.sigmas = pattern.white.norm();
    patterns.push_back(std::move(pattern));
  }
  stable_sort(patterns,
              [](const Pattern& a, const Pattern& b) { return a.found.sigmas > b.found.sigmas; });
  std::vector<DetectableEffect> found;
  for (std::size_t i = 0; i < patterns.size(); ++i) {
    for (std::size_t j = 0; j < patterns.size(); ++j) {
      if (i == j) continue;
      const double together = patterns[i].found.sigmas * patterns[j].found.sigmas;
      if (together > 0.0 && std::abs(patterns[i].white.dot(patterns[j].white)) > kOneDirection * together)
        patterns[i].found.same_as.push_back(j);
    }
    found.push_back(patterns[i].found);
  }
  return found;
}

}  // namespace chaintrue::grid
