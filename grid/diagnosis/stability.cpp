// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/stability.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/held_out_fold.hpp"
#include "grid/parallel.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kFewestLines = 3;
constexpr std::size_t kFewestOnLine = 3;  // on average
/// Log odds if no alternative remains: the largest that a double can represent.
constexpr double kMostOdds = 700.0;

bool is_at_mark(const ObservationSet& session, const NumberedUnit& unit) {
  return session.parts[unit.part].reads_chains();
}

/// Runs of points along a coordinate; empty if the marks are not in lines.
std::vector<LeftOut> lines_along(const ObservationSet& session, Removal::What what,
                                 double model::MarkPoint::*coordinate) {
  const auto at = [&](std::size_t u) {
    const ObservationPart& part = session.parts[session.units[u].part];
    return session.places[part.first_place + u - part.first_unit].mark.*coordinate;
  };
  Indices order = numbers_below(session.units.size());
  std::erase_if(order, [&](std::size_t u) { return !is_at_mark(session, session.units[u]); });
  stable_sort(order, ascending(at));
  std::vector<LeftOut> lines;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || at(order[k]) - at(order[k - 1]) >= kLineGapMm) lines.push_back({what});
    lines.back().units.push_back(order[k]);
    lines.back().at_mm += at(order[k]);
  }
  if (lines.size() < kFewestLines || order.size() < kFewestOnLine * lines.size()) return {};
  for (LeftOut& line : lines) line.at_mm /= as_double(line.units.size());
  return lines;
}

/// Whether a model agrees with the verdict: every cause named, or one of the set.
bool agrees(const Analysis& a, const CandidateModel& model) {
  const auto acts = [&](std::size_t index) {
    return any_of(model.regressors,
                  [&](int k) { return a.decision.class_of(regressor(a, k).cause) == index; });
  };
  const auto& listed = a.decision.listed;
  return a.decision.verdict == Verdict::named_set ? any_of(listed, acts) : all_of(listed, acts);
}

/// Logarithm of the verdict's odds.
double log_odds_of_verdict(const Analysis& a, const ModelComparison& comparison) {
  std::vector<double> with, against;
  for (const CandidateModel& model : comparison.models)
    (agrees(a, model) ? with : against).push_back(model.log_weight);
  return std::clamp(log_sum(with) - log_sum(against), -kMostOdds, kMostOdds);
}

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace

std::vector<LeftOut> holes_to_leave_out(const ObservationSet& session) {
  std::vector<LeftOut> holes;
  for (const auto& [part, tape] : parts_of<observation::TapeDistances>(session)) {
    const std::size_t first = holes.size();
    for (const observation::Place& hole : tape->places())
      holes.push_back({Removal::What::hole, hole.index});
    for (std::size_t k = 0; k < tape->units().size(); ++k) {
      const HoleDistance& distance = tape->set().distances[k];
      holes[first + distance.from].units.push_back(part->first_unit + k);
      if (!distance.edge) holes[first + distance.to].units.push_back(part->first_unit + k);
    }
  }
  std::erase_if(holes, [](const LeftOut& hole) { return hole.units.empty(); });
  return holes;
}

std::vector<LeftOut> groups_to_leave_out(const ObservationSet& session) {
  using What = Removal::What;
  std::vector<LeftOut> groups = holes_to_leave_out(session);
  for (std::size_t u = 0; u < session.units.size(); ++u) {
    const NumberedUnit& unit = session.units[u];
    groups.push_back(
        {is_at_mark(session, unit) ? What::point : What::distance, unit.index, 0.0, {u}});
  }
  append_all(groups, lines_along(session, What::column, &model::MarkPoint::x_mm));
  append_all(groups, lines_along(session, What::row, &model::MarkPoint::y_mm));
  std::erase_if(groups, [&](const LeftOut& group) {
    return session.units.size() - group.units.size() < session.fewest_units;
  });
  sort(groups, ascending([](const LeftOut& group) {
         return std::tuple(group.what, group.index, group.at_mm);
       }));
  return groups;
}

bool still_named(const Decision& all, const Decision& without) {
  const std::vector<CauseId> leaders = without.leaders();
  const auto is_listed = [&](std::size_t index) {
    return any_of(leaders, [&](const CauseId& leader) { return all.class_of(leader) == index; });
  };
  if (all.verdict == Verdict::named_set) return is_listed(all.listed.front());
  if (without.verdict == Verdict::named_set)
    return all.listed.size() == 1 && all.class_of(leaders.front()) == all.listed.front();
  return all_of(all.listed, is_listed);
}

std::optional<Stability> examine_stability(const Analysis& a) {
  if (a.decision.listed.empty()) return std::nullopt;
  const std::vector<LeftOut> groups = groups_to_leave_out(a.session);
  if (groups.empty()) return std::nullopt;
  const Downdating downdating(a.system, a.comparison);
  const double all = log_odds_of_verdict(a, downdating.without({}).comparison);
  Stability result;
  result.probability = probability_of(all);
  tell(a.options.progress, {"the name without each reading", 2, 4});
  result.removals.resize(groups.size());
  for_each_index(groups.size(), [&](std::size_t k) {
    const LeftOut& group = groups[k];
    const auto [without, decision] = decided_without(a, downdating, group.units);
    const double log_odds = log_odds_of_verdict(a, without.comparison);
    Removal& removal = result.removals[k];
    removal.what = group.what;
    removal.index = group.index;
    removal.at_mm = group.at_mm;
    removal.points = group.units.size();
    removal.verdict = decision.verdict;
    removal.causes = decision.leaders();
    removal.stands = still_named(a.decision, decision);
    removal.probability = probability_of(log_odds);
    removal.support = all - log_odds;
  });
  return result;
}

}  // namespace chaintrue::grid::diagnosis
