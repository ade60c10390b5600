// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/stability.hpp"

#include <fmt/format.h>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// The removal of one reading without which nothing would be named; null if there is none.
const Removal* made_by(const Stability& stability) {
  const Removal* most = nullptr;
  for (const Removal& removal : stability.removals) {
    const bool one =
        removal.what == Removal::What::point || removal.what == Removal::What::distance;
    // Becoming less certain without a reading does not mean that the name depends on it.
    if (!one || !removal.causes.empty() || removal.probability >= kLikelierThanNot) continue;
    if (most == nullptr || removal.support > most->support) most = &removal;
  }
  return most;
}

std::string refusal_words(const ObservationSet& session, const Removal& reading, std::size_t unit,
                          const CauseId& cause, double probability) {
  const bool point = reading.what == Removal::What::point;
  const std::string what =
      point ? fmt::format("Point {}", reading.index + 1) : "The" + name_of(session, unit).substr(3);
  return fmt::format(
      "{} alone suggests a cause ({}, {:.0f} %); without it there is none. A lasting cause shows "
      "in more than one {}, so the {} was rejected: measure it again{}.",
      what, sized(cause, {}), 100.0 * probability, point ? "point" : "distance",
      point ? "point" : "distance", point ? ", and once more next to it" : "");
}

bool may_be_refused(const Analysis& a) {
  const Verdict verdict = a.decision.verdict;
  if (verdict != Verdict::named && verdict != Verdict::several_causes) return false;
  return none_of(a.decision.regressors, [&](int k) { return regressor(a, k).fixed; });
}

}  // namespace

std::optional<std::string> refuse_name_of_one_reading(const std::optional<Stability>& stability,
                                                      Analysis& a) {
  if (!stability || a.options.given_cause || !may_be_refused(a)) return std::nullopt;
  const Removal* reading = made_by(*stability);
  if (reading == nullptr) return std::nullopt;
  const auto number = as_size(reading - stability->removals.data());
  const std::size_t unit = groups_to_leave_out(a.session)[number].units.front();
  const ClassProbability leader = a.decision.marginal.front();
  const CauseId cause = a.decision.classes[leader.index].front();
  Flags excluded(a.session.units.size(), false);
  excluded[unit] = true;
  a.comparison =
      compare_models(a.system, excluded,
                     {.kernels = best_kernels(a.comparison), .given_cause = a.options.given_cause});
  decide_by(calibrated_rules(), false, a);
  return refusal_words(a.session, *reading, unit, cause, leader.probability);
}

}  // namespace chaintrue::grid::diagnosis
