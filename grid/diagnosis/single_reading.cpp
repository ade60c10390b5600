// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/single_reading.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "grid/diagnosis/leading.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Position in the session of the point without which nothing would be named.
std::optional<std::size_t> made_by(const Session& session, const Stability& stability) {
  const Removal* most = nullptr;
  for (const Removal& removal : stability.removals) {
    if (removal.what != Removal::What::point || !removal.causes.empty()) continue;
    if (most == nullptr || removal.support > most->support) most = &removal;
  }
  if (most == nullptr) return std::nullopt;
  for (std::size_t i = 0; i < session.points.size(); ++i) {
    if (session.points[i].index == most->index) return i;
  }
  return std::nullopt;
}

bool may_be_refused(const Analysis& a) {
  const Verdict verdict = a.decision.verdict;
  if (verdict != Verdict::named && verdict != Verdict::several_causes) return false;
  return std::none_of(a.decision.regressors.begin(), a.decision.regressors.end(), [&](int k) {
    return regressor(a, k).fixed;
  });
}

}  // namespace

std::optional<std::string> refuse_name_of_one_reading(const Session& session,
                                                      const DiagnosisOptions& options,
                                                      const std::optional<Stability>& stability,
                                                      Analysis& a) {
  if (!stability || session.distances || options.told || !may_be_refused(a)) return std::nullopt;
  const auto point = made_by(session, *stability);
  if (!point) return std::nullopt;
  const ClassProbability leader = a.decision.marginal.front();
  const CauseId cause = a.decision.classes[leader.index].front();
  std::vector<bool> aside(session.units(), false);
  aside[*point] = true;
  const std::vector<bool> none(session.units(), false);
  a.comparison = compare_models(session, a.system, aside, {options.steps, true, options.told});
  a.decision = decide_beside_discrepancy(session, a.system, a.comparison, none, false);
  a.estimate = estimate(session,
                        a.system,
                        marginalised_system(a),
                        a.decision.regressors,
                        a.decision.discrepancy_left ? a.decision.best_discrepancy : -1);
  return fmt::format(
      "Point {} by itself would make a name of it ({}{}, {:.0f} %); without it nothing is named. A "
      "lasting cause shows in more than one point, so the point is set aside: measure it again, "
      "and "
      "once more beside it.",
      session.points[*point].index + 1,
      cause.effect->cause,
      side_words(cause),
      100.0 * leader.probability);
}

}  // namespace chaintrue::grid::diagnosis
