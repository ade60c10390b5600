// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>

#include "grid/diagnosis/held_out_improvement.hpp"
#include "grid/diagnosis/workshop_units.hpp"
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
                                 double MarkPoint::*coordinate) {
  const auto at = [&](std::size_t u) {
    const ObservationPart& part = session.parts[session.units[u].part];
    return session.places[part.first_place + u - part.first_unit].mark.*coordinate;
  };
  Indices order = numbers_below(session.units.size());
  std::erase_if(order, [&](std::size_t u) { return !is_at_mark(session, session.units[u]); });
  stable_sort(order, ascending(at));
  std::vector<LeftOut> lines;
  for (const auto k : each_index(order)) {
    if (k == 0 || at(order[k]) - at(order[k - 1]) >= kLineGapMm) lines.push_back({{what}});
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
  for (const auto& [part, tape] : parts_of<TapeDistances>(session)) {
    const std::size_t first = holes.size();
    for (const Place& hole : tape->places()) holes.push_back({{Removal::What::hole, hole.index}});
    for (const auto k : each_index(tape->units())) {
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
  for (const auto u : each_index(session.units)) {
    const NumberedUnit& unit = session.units[u];
    groups.push_back({{is_at_mark(session, unit) ? What::point : What::distance, unit.index}, {u}});
  }
  append_all(groups, lines_along(session, What::column, &MarkPoint::x_mm));
  append_all(groups, lines_along(session, What::row, &MarkPoint::y_mm));
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
    removal = group;
    removal.points = group.units.size();
    removal.verdict = decision.verdict;
    removal.causes = decision.leaders();
    removal.stands = still_named(a.decision, decision);
    removal.probability = probability_of(log_odds);
    removal.support = all - log_odds;
  });
  return result;
}

namespace {

/// Up to this many points are listed; for more, their count and the first ones.
constexpr std::size_t kMostNumbers = 5;
constexpr double kBeyondDoubt = 0.995;

struct Kind {
  Removal::What what;
  std::string_view one;
  std::string_view many;
};
constexpr std::array kKinds = {Kind{Removal::What::point, "point", "points"},
                               Kind{Removal::What::column, "column of marks", "columns of marks"},
                               Kind{Removal::What::row, "row of marks", "rows of marks"},
                               Kind{Removal::What::distance, "distance", "distances"},
                               Kind{Removal::What::hole, "hole", "holes"}};

bool is_of_line(Removal::What what) {
  return what == Removal::What::column || what == Removal::What::row;
}

std::vector<const Removal*> of_kind(const Stability& stability, Removal::What what, bool changing) {
  std::vector<const Removal*> found;
  for (const Removal& removal : stability.removals) {
    if (removal.what == what && !(changing && removal.stands)) found.push_back(&removal);
  }
  return found;
}

std::string place(const Diagnosis& diagnosis, const Removal& removal) {
  switch (removal.what) {
    case Removal::What::column:
      return fmt::format("x = {} mm", std::lround(removal.at_mm));
    case Removal::What::row:
      return fmt::format("y = {} mm", std::lround(removal.at_mm));
    case Removal::What::distance:
      return words_of_ends(diagnosis.distances.at(removal.index));
    case Removal::What::hole:
      return diagnosis.holes.at(removal.index).name;
    case Removal::What::point:
      break;
  }
  return fmt::format("{}", removal.index + 1);
}

/// "point 17", "points 3, 9 and 17", "the column of marks at x = 1200 mm".
std::string named_places(const Diagnosis& diagnosis, const Kind& kind,
                         const std::vector<const Removal*>& removals) {
  std::vector<std::string> places;
  for (const Removal* one : removals) {
    if (places.size() < kMostNumbers) places.push_back(place(diagnosis, *one));
  }
  if (removals.size() > kMostNumbers) places.emplace_back("others");
  const bool single = removals.size() == 1;
  const std::string where = joined(places, "and", ", ");
  const std::string_view noun = single ? kind.one : kind.many;
  return is_of_line(kind.what) ? fmt::format("the {} at {}", noun, where)
                               : fmt::format("{} {}", noun, where);
}

std::string fate(const Removal& removal) {
  if (removal.causes.empty()) return "nothing would be named";
  std::vector<std::string> names;
  for (const CauseId& cause : removal.causes) {
    const std::string_view side = name(cause.side);
    names.push_back(fmt::format("{}{}{}", cause.effect->id, side.empty() ? "" : " ", side));
    std::replace(names.back().begin(), names.back().end(), '_', ' ');
  }
  return fmt::format("the verdict would be {}",
                     joined(names, removal.verdict == Verdict::named_set ? "or" : "and", ", "));
}

/// Whether a column or row that was left out holds the point.
bool lies_on(const Diagnosis& diagnosis, const Removal& line, std::size_t point) {
  auto* found = find_where(diagnosis.points, having(&PointPicture::index, point));
  if (!is_of_line(line.what) || found == nullptr) return false;
  const double at_mm = line.what == Removal::What::column ? found->mark.x_mm : found->mark.y_mm;
  return std::abs(at_mm - line.at_mm) < kLineGapMm;
}

}  // namespace

Indices influential_points(const Diagnosis& diagnosis) {
  Indices points;
  if (!diagnosis.stability) return points;
  for (const Removal* removal : of_kind(*diagnosis.stability, Removal::What::point, true)) {
    points.push_back(removal->index);
  }
  return points;
}

std::string stability_in_words(const Diagnosis& diagnosis) {
  const Stability& stability = *diagnosis.stability;
  std::vector<std::string> tried;
  std::size_t changes = 0;
  for (const Kind& kind : kKinds) {
    const auto all = of_kind(stability, kind.what, false);
    if (all.empty()) continue;
    changes += of_kind(stability, kind.what, true).size();
    tried.push_back(fmt::format("{} {}", all.size(), all.size() == 1 ? kind.one : kind.many));
  }
  const auto weakest = min_element(stability.removals, ascending(&Removal::probability));
  const Kind& kind = kKinds[as_size(weakest->what)];
  const std::string which = joined(tried, "and", ", ");
  const std::string text =
      changes == 0 ? fmt::format("Leaving out any of {} does not change the answer.", which)
                   : fmt::format("Of {}, each left out in turn, {} would change the answer.", which,
                                 changes);
  if (weakest->probability > kBeyondDoubt) return text;
  return text + fmt::format(" It is least certain without {}: then {}, with all {} {}.",
                            named_places(diagnosis, kind, {&*weakest}),
                            percent(weakest->probability),
                            diagnosis.observations == Observations::points ? "points" : "readings",
                            percent(stability.probability));
}

std::string influence_in_words(const Diagnosis& diagnosis) {
  if (!diagnosis.stability) return "";
  std::string text;
  const auto points = influential_points(diagnosis);
  for (const Kind& kind : kKinds) {
    auto changes = of_kind(*diagnosis.stability, kind.what, true);
    // A line is mentioned only if not a single point of it is responsible.
    std::erase_if(changes, [&](const Removal* removal) {
      return any_of(points, [&](std::size_t point) { return lies_on(diagnosis, *removal, point); });
    });
    if (changes.empty()) continue;
    text +=
        fmt::format(" {} rests on {}{}: without {} {}.",
                    diagnosis.causes.size() == 1 ? "The name" : "What is named",
                    changes.size() == 1 ? "" : "each of ", named_places(diagnosis, kind, changes),
                    changes.size() == 1 ? "it" : "the first of these", fate(*changes.front()));
  }
  return text;
}

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
  if (!stability || !may_be_refused(a)) return std::nullopt;
  const Removal* reading = made_by(*stability);
  if (reading == nullptr) return std::nullopt;
  const auto number = as_size(reading - stability->removals.data());
  const std::size_t unit = groups_to_leave_out(a.session)[number].units.front();
  const ClassProbability leader = a.decision.marginal.front();
  const CauseId cause = a.decision.classes[leader.index].front();
  Flags excluded(a.session.units.size(), false);
  excluded[unit] = true;
  a.comparison = compare_models(a.system, excluded, {.kernels = best_kernels(a.comparison)});
  decide_by(calibrated_rules(), false, a);
  return refusal_words(a.session, *reading, unit, cause, leader.probability);
}

}  // namespace chaintrue::grid::diagnosis
