// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/belts_trial.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/diagnose.hpp"
#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::sealed {

grid::MeasuredBelts measured_belts_of(const generator::BeltDraw& draw) {
  grid::MeasuredBelts belts;
  belts.machine.lengths = model::BeltLengths::belt;
  int order = 0;
  for (const generator::FourLengths& read : draw.lengths_mm) {
    grid::BeltPoint point;
    point.lengths_mm = {read[0], read[1], read[2], read[3]};
    point.pull = grid::BeltPull{draw.pulls[static_cast<std::size_t>(order)]};
    point.order = order++;
    belts.points.push_back(std::move(point));
  }
  return belts;
}

namespace {

bool same_bad(const generator::BeltSecret& secret, const grid::diagnosis::Diagnosis& found) {
  if (found.outliers.size() != secret.bad.size()) return false;
  return grid::all_of(found.outliers, [&](const auto& bad) {
    return grid::any_of(secret.bad, [&](const auto& hidden) {
      return bad.belt && static_cast<int>(bad.index) == hidden[0] &&
             (static_cast<int>(*bad.belt) == hidden[1] ||
              (bad.or_belt && static_cast<int>(*bad.or_belt) == hidden[1]));
    });
  });
}

/// For the ten leading classes of causes. Also false if the hidden cause leads none of them.
bool is_separable(const generator::BeltSecret& secret, const grid::MeasuredBelts& belts) {
  namespace diagnosis = grid::diagnosis;
  constexpr std::size_t kCompared = 10;
  auto analysed = diagnosis::analyse(belts, {});
  if (!analysed) return false;
  diagnosis::judge(diagnosis::BeltRules(*analysed), *analysed);
  const diagnosis::Analysis& a = *analysed;
  std::vector<diagnosis::CauseId> leading;
  for (const diagnosis::ClassProbability& one : a.decision.marginal) {
    if (leading.size() < kCompared) leading.push_back(a.decision.classes[one.index].front());
  }
  const auto* hidden = grid::find_where(leading, [&](const auto& cause) {
    return cause.effect->id == secret.effect && name(cause.side) == secret.side;
  });
  if (!hidden) return false;
  const auto column = [&a](const diagnosis::CauseId& cause) {
    return diagnosis::reduced(diagnosis::marginalised_system(a),
                              a.system.g.col(diagnosis::best_regressor(a, cause)));
  };
  const Eigen::VectorXd own = column(*hidden);
  return grid::all_of(leading, [&](const diagnosis::CauseId& other) {
    if (other == *hidden) return true;
    const Eigen::VectorXd its = column(other);
    const double collinearity = diagnosis::collinearity_of(own.dot(its), own.norm() * its.norm());
    // 1.645 sqrt(2 (1 - collinearity)) separates 95 of 100; members of a class are never separated.
    const double apart = std::max(1.0 - collinearity, 1.0 - diagnosis::kOneClass);
    return 1.645 * std::sqrt(2.0 / apart) <= secret.strength;
  });
}

}  // namespace

Outcome run_belts_trial(const std::string& kind, const generator::BeltRecipe& recipe,
                        std::uint64_t seed, bool more) {
  const generator::BeltDraw draw = generator::draw_belts(recipe, seed);
  const generator::BeltSecret& secret = draw.secret;
  const grid::MeasuredBelts belts = measured_belts_of(draw);
  grid::diagnosis::DiagnosisOptions how;
  how.next_measurements = false;
  const auto found = grid::diagnosis::diagnose(belts, how);
  Trial trial(found ? *found : grid::diagnosis::Diagnosis{});
  if (!secret.effect.empty()) trial.hidden.push_back(id_of(secret.effect, secret.side));
  Outcome outcome = outcome_of(kind, seed, trial);
  outcome.points = static_cast<int>(draw.lengths_mm.size());
  outcome.strength = secret.strength;
  const bool alone = outcome.has("alone"), held = outcome.has("held"),
             named = !trial.causes.empty();
  const bool one = trial.verdict == grid::diagnosis::Verdict::named;
  outcome.facts.clear();
  if (!found) outcome.fail();
  if (!found) return outcome;
  outcome.add("alone", alone);
  outcome.add("held", held);
  outcome.add("right_belt", named && name(found->causes.front().cause.side) == secret.side);
  outcome.add("nothing_false", !named || held);
  outcome.add("no_name", !named);
  outcome.add("no_pattern", trial.verdict != grid::diagnosis::Verdict::model_discrepancy);
  outcome.add("bad_found", same_bad(secret, *found));
  if (!more) return outcome;
  outcome.add("separable", !secret.effect.empty() && is_separable(secret, belts));
  outcome.add("one_belt", named && secret.side.size() == 2);
  outcome.add("set", named && !one);
  outcome.add("wrong", named && one && !alone);
  return outcome;
}

}  // namespace chaintrue::sealed
