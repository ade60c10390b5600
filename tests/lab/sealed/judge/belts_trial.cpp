// SPDX-License-Identifier: GPL-3.0-or-later
#include "sealed/judge/belts_trial.hpp"

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/best_model.hpp"
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
  return std::all_of(found.outliers.begin(), found.outliers.end(), [&](const auto& bad) {
    return std::any_of(secret.bad.begin(), secret.bad.end(), [&](const auto& hidden) {
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
  const auto analysed = diagnosis::analyse(belts, {});
  if (!analysed) return false;
  const diagnosis::Analysis& a = *analysed;
  std::vector<diagnosis::CauseId> leading;
  for (const diagnosis::ClassProbability& one : a.decision.marginal) {
    if (leading.size() < kCompared) leading.push_back(a.decision.classes[one.index].front());
  }
  const auto hidden = std::find_if(leading.begin(), leading.end(), [&](const auto& cause) {
    return cause.effect->id == secret.effect && name(cause.side) == secret.side;
  });
  if (hidden == leading.end()) return false;
  const auto& g = diagnosis::marginalised_system(a).g;
  return std::all_of(leading.begin(), leading.end(), [&](const diagnosis::CauseId& other) {
    if (other == *hidden) return true;
    const double collinearity = diagnosis::collinearity_of(g.col(diagnosis::best_regressor(a, *hidden)),
                                                           g.col(diagnosis::best_regressor(a, other)));
    // 1.645 sqrt(2 (1 - collinearity)) separates 95 of 100; members of a class are never separated.
    const double apart = std::max(1.0 - collinearity, 1.0 - diagnosis::kOneClass);
    return 1.645 * std::sqrt(2.0 / apart) <= secret.strength;
  });
}

}  // namespace

BeltsTrial run_belts_trial(const generator::BeltRecipe& recipe, std::uint64_t seed) {
  const generator::BeltDraw draw = generator::draw_belts(recipe, seed);
  BeltsTrial trial;
  trial.seed = seed;
  trial.points = static_cast<int>(draw.lengths_mm.size());
  trial.secret = draw.secret;
  const grid::MeasuredBelts belts = measured_belts_of(draw);
  grid::diagnosis::DiagnosisOptions how;
  how.next_measurements = false;
  const auto found = grid::diagnosis::diagnose(belts, how);
  if (!found) {
    trial.failed = true;
    return trial;
  }
  trial.verdict = name(found->verdict);
  trial.causes = named_causes(*found);
  trial.named = !found->causes.empty();
  const auto is_hidden = [&](const auto& cause) {
    return cause.cause.effect->id == draw.secret.effect &&
           name(cause.cause.side) == draw.secret.side;
  };
  const auto holds = [&](const grid::diagnosis::Cause& cause) {
    return is_hidden(cause) || std::any_of(cause.same_as.begin(), cause.same_as.end(), is_hidden);
  };
  trial.held = std::any_of(found->causes.begin(), found->causes.end(), holds);
  trial.exact = found->verdict == grid::diagnosis::Verdict::named && trial.held;
  trial.right_belt = trial.named && name(found->causes.front().cause.side) == draw.secret.side;
  trial.separable = !draw.secret.effect.empty() && is_separable(draw.secret, belts);
  trial.bad_found = same_bad(draw.secret, *found);
  return trial;
}

}  // namespace chaintrue::sealed
