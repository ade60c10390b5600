// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/causes_given_law.hpp"

#include <cmath>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/findings.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// If no cause alone is this likely, none will be named: the odds of a cause named at 90 % are
/// eighty times these, and only two causes that mask each other gain as much together.
constexpr double kHardlyLikely = 0.1;

/// Whether some cause deserves a second comparison, by its evidence alone.
bool may_name_a_cause(const Analysis& a, const VectorXd& rows) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const VectorXd e = marginalised.e - reduced(marginalised, rows);
  const double beforehand = log_odds_of_another(a.system, {}, false);
  const double least = std::log(kHardlyLikely / (1.0 - kHardlyLikely));
  return any_of(single_scores(a.system, marginalised, e),
                [&](const CauseScore& own) { return own.log_factor + beforehand > least; });
}

bool holds(const Analysis& a, const CauseId& cause) {
  return contains(a.decision.listed, a.decision.class_of(cause));
}

}  // namespace

std::optional<VectorXd> rows_of_claimed_law(const Analysis& a, const LawsFound& laws) {
  if (laws.laws.empty() || laws.laws.front().probability < kLawClaimed) return std::nullopt;
  VectorXd rows = laws.heaviest.front().rows(a.system);
  if (a.decision.listed.empty() && !may_name_a_cause(a, rows)) return std::nullopt;
  return rows;
}

std::vector<CauseGivenLaw> changed_causes(const Analysis& without_law, const Analysis& given_law) {
  std::vector<CauseGivenLaw> changed;
  for (Cause& cause : causes_found(given_law)) {
    if (holds(without_law, cause.cause)) continue;
    changed.push_back({cause.cause, cause.probability, probability_of(without_law, cause.cause),
                       std::move(cause.parameters)});
    for (SameCause& same : cause.same_as) changed.back().same_as.push_back(same.cause);
  }
  stable_sort(changed, descending(&CauseGivenLaw::probability));
  for (const CauseId& cause : without_law.decision.leaders()) {
    if (holds(given_law, cause)) continue;
    changed.push_back(
        {cause, probability_of(given_law, cause), probability_of(without_law, cause), {}});
  }
  return changed;
}

void take_names_back(const Analysis& given_law, Analysis& a) {
  std::vector<CauseId> lost = a.decision.leaders();
  std::erase_if(lost, [&](const CauseId& cause) {
    return holds(given_law, cause) || probability_of(given_law, cause) >= kLikelierThanNot;
  });
  if (lost.empty()) return;
  if (lost.size() == a.decision.listed.size()) {
    withdraw_names(a.comparison, a.decision);
  } else if (a.decision.verdict == Verdict::several_causes) {
    std::erase_if(a.decision.regressors, [&](int k) {
      return any_of(
          lost, [&](const CauseId& cause) { return same_class(a, regressor(a, k).cause, cause); });
    });
    std::erase_if(a.decision.listed, [&](std::size_t index) {
      return contains(lost, a.decision.classes[index].front());
    });
    if (a.decision.listed.size() == 1) a.decision.verdict = Verdict::named;
  }
  estimate_decided(a);
  for (ClassProbability& one : a.decision.marginal) {
    const CauseId& cause = a.decision.classes[one.index].front();
    if (contains(lost, cause)) one.probability = probability_of(given_law, cause);
  }
  stable_sort(a.decision.marginal, descending(&ClassProbability::probability));
}

std::vector<CauseGivenLaw> name_given_law(const LawsFound& laws, const AnalysisRules& rules,
                                          Analysis& a) {
  const auto rows = rows_of_claimed_law(a, laws);
  if (!rows) return {};
  const Analysis given = analyse_without(a, *rows, rules);
  std::vector<CauseGivenLaw> changed = changed_causes(a, given);
  take_names_back(given, a);
  return changed;
}

}  // namespace chaintrue::grid::diagnosis
