// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/stability.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
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

/// Units that read the chains at one mark.
Indices units_at_marks(const ObservationSet& session) {
  Indices result;
  for (std::size_t u = 0; u < session.units.size(); ++u) {
    if (session.parts[session.units[u].part].reads_chains()) result.push_back(u);
  }
  return result;
}

const model::MarkPoint& mark_of(const ObservationSet& session, std::size_t unit) {
  const ObservationPart& part = session.parts[session.units[unit].part];
  return session.places[part.first_place + unit - part.first_unit].mark;
}

/// Runs of points along a coordinate; empty if the marks are not in lines.
std::vector<LeftOut> lines_along(const ObservationSet& session,
                                 Removal::What what,
                                 double model::MarkPoint::*coordinate) {
  const auto at = [&](std::size_t u) { return mark_of(session, u).*coordinate; };
  Indices order = units_at_marks(session);
  stable_sort(order, ascending(at));
  std::vector<LeftOut> lines;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k == 0 || at(order[k]) - at(order[k - 1]) >= kLineGapMm)
      lines.push_back({what, 0, 0.0, {}});
    lines.back().units.push_back(order[k]);
    lines.back().at_mm += at(order[k]);
  }
  if (lines.size() < kFewestLines || order.size() < kFewestOnLine * lines.size()) return {};
  for (LeftOut& line : lines) {
    line.at_mm /= as_double(line.units.size());
    sort(line.units);
  }
  return lines;
}

void add_by_index(std::vector<LeftOut> more, std::vector<LeftOut>& groups) {
  sort(more, ascending(&LeftOut::index));
  append_all(groups, more);
}

/// Each distance, and each hole with all its distances.
void add_distances_and_holes(const ObservationSet& session, std::vector<LeftOut>& groups) {
  std::vector<LeftOut> distances;
  std::vector<LeftOut> holes;
  for (const auto& [part, tape] : parts_of<observation::TapeDistances>(session)) {
    const std::size_t first_hole = holes.size();
    for (const observation::Place& hole : tape->places()) {
      holes.push_back({Removal::What::hole, hole.index, 0.0, {}});
    }
    for (std::size_t k = 0; k < tape->units().size(); ++k) {
      const std::size_t unit = part->first_unit + k;
      const HoleDistance& distance = tape->set().distances[k];
      distances.push_back({Removal::What::distance, tape->units()[k].index, 0.0, {unit}});
      holes[first_hole + distance.from].units.push_back(unit);
      if (!distance.edge) holes[first_hole + distance.to].units.push_back(unit);
    }
  }
  std::erase_if(holes, [](const LeftOut& hole) { return hole.units.empty(); });
  add_by_index(std::move(distances), groups);
  add_by_index(std::move(holes), groups);
}

/// Whether a model agrees with the verdict: every cause named, or one of the set.
class Statement {
 public:
  explicit Statement(const Analysis& a) : a_(a) {}

  [[nodiscard]] bool holds(const CandidateModel& model) const {
    const auto acts = [&](std::size_t index) {
      const CauseClass& members = a_.decision.classes[index];
      return any_of(model.regressors,
                    [&](int k) { return contains(members, regressor(a_, k).cause); });
    };
    const auto& listed = a_.decision.listed;
    return a_.decision.verdict == Verdict::named_set ? any_of(listed, acts) : all_of(listed, acts);
  }

  /// Logarithm of its odds.
  [[nodiscard]] double log_odds(const ModelComparison& comparison) const {
    std::vector<double> with, against;
    for (const CandidateModel& model : comparison.models)
      (holds(model) ? with : against).push_back(model.log_weight);
    return std::clamp(log_sum(with) - log_sum(against), -kMostOdds, kMostOdds);
  }

 private:
  const Analysis& a_;
};

double probability_of(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

}  // namespace

std::vector<LeftOut> groups_to_leave_out(const ObservationSet& session) {
  std::vector<LeftOut> groups;
  std::vector<LeftOut> points;
  for (const std::size_t u : units_at_marks(session)) {
    points.push_back({Removal::What::point, session.units[u].index, 0.0, {u}});
  }
  add_by_index(std::move(points), groups);
  for (const auto& [what, coordinate] : {std::pair(Removal::What::column, &model::MarkPoint::x_mm),
                                         std::pair(Removal::What::row, &model::MarkPoint::y_mm)}) {
    const auto lines = lines_along(session, what, coordinate);
    append_all(groups, lines);
  }
  add_distances_and_holes(session, groups);
  std::erase_if(groups, [&](const LeftOut& group) {
    return session.units.size() - group.units.size() < session.fewest_units;
  });
  return groups;
}

bool still_named(const Decision& all, const Decision& without) {
  const auto is_listed = [&](std::size_t index) {
    const CauseClass& members = all.classes[index];
    return any_of(without.listed, [&](std::size_t other) {
      const CauseId& leader = without.classes[other].front();
      return contains(members, leader);
    });
  };
  const bool set_without = without.verdict == Verdict::named_set;
  if (all.verdict == Verdict::named_set) return is_listed(all.listed.front());
  if (set_without) {
    const CauseId& leader = without.classes[without.listed.front()].front();
    const CauseClass& members = all.classes[all.listed.front()];
    return all.listed.size() == 1 && contains(members, leader);
  }
  return all_of(all.listed, is_listed);
}

std::optional<Stability> examine_stability(const Analysis& a) {
  if (a.decision.listed.empty()) return std::nullopt;
  const std::vector<LeftOut> groups = groups_to_leave_out(a.session);
  if (groups.empty()) return std::nullopt;
  const Downdating downdating(a.system, a.comparison);
  const Statement statement(a);
  const double all = statement.log_odds(downdating.without({}).comparison);
  Stability result;
  result.probability = probability_of(all);
  tell(a.options.progress, {"the name without each reading", 2, 4});
  result.removals.resize(groups.size());
  for_each_index(groups.size(), [&](std::size_t k) {
    const LeftOut& group = groups[k];
    const auto [without, decision] = decided_without(a, downdating, group.units);
    const double log_odds = statement.log_odds(without.comparison);
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
