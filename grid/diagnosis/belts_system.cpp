// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "grid/diagnosis/discrepancy.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// Degrees of freedom of the prior noise of a belt's reading, which is hardly known.
constexpr double kNoiseDof = 2.0;
/// Visits at which something may set in, spread over the session: neighbours among 24 have a
/// collinearity of 0.97, and the best is refined between its neighbours afterwards.
constexpr std::size_t kVisits = 24;
/// Directions in which an anchor may slip: the nearest is at most a sixteenth of a turn off, a
/// collinearity of 0.92.
constexpr int kWays = 8;
/// Fewest visits on either side of a step, or it cannot be distinguished from bad readings.
constexpr std::size_t kLeastAfter = 2;

/// Whole teeth that a belt may jump, with their shares: one is usual, and a lost magnet gives a
/// turn of the encoder.
struct Teeth {
  double teeth;
  double share;
};
constexpr Teeth kTeeth[] = {{1.0, 0.25}, {-1.0, 0.25}, {2.0, 0.1},  {-2.0, 0.1},
                            {3.0, 0.05}, {-3.0, 0.05}, {22.0, 0.1}, {-22.0, 0.1}};

/// No published frame shows anything besides stretch. One other cause is a third as likely as with
/// chains: a sixth as likely as none. Nearly all frames leave a smooth pattern as well, so a
/// pattern makes another cause no likelier.
CausePrior prior_of_belts() {
  constexpr double kRarerThanChains = 3.0;
  CausePrior prior{.shares = 0.0, .odds_given_discrepancy = 1.0};
  for (const Effect* effect : model::belts::belt_effects()) {
    if (!(effect->expected > 0.0)) prior.shares += kRarerThanChains * effect->share;
  }
  return prior;
}

/// The visits in order, without the first few and the last few.
std::vector<int> visits_to_set_in(const MeasuredBelts& belts) {
  std::vector<int> orders;
  for (const BeltPoint& point : belts.points) {
    if (point.order) orders.push_back(*point.order);
  }
  sort(orders);
  if (orders.size() <= 2 * kLeastAfter) return {};
  return {orders.begin() + kLeastAfter, orders.end() - (kLeastAfter - 1)};
}

std::vector<int> thinned(const std::vector<int>& visits) {
  if (visits.size() <= kVisits) return visits;
  return mapped(each_below(kVisits),
                [&](std::size_t i) { return visits[i * visits.size() / kVisits]; });
}

/// The visits between the neighbours of one of the thinned visits.
std::vector<int> about(const std::vector<int>& visits, int visit) {
  const auto half = static_cast<std::ptrdiff_t>(visits.size() / kVisits + 1);
  const auto at = std::lower_bound(visits.begin(), visits.end(), visit) - visits.begin();
  const auto last = static_cast<std::ptrdiff_t>(visits.size());
  return {visits.begin() + std::clamp<std::ptrdiff_t>(at - half, 0, last),
          visits.begin() + std::clamp<std::ptrdiff_t>(at + half + 1, 0, last)};
}

/// For an expected effect, the share that makes it alone as likely as no cause (CausePrior).
double share_of(const Effect& effect, const CausePrior& prior) {
  return effect.expected > 0.0 ? effect.expected * prior.shares * kPriorOfNothing / kPriorOfOne
                               : effect.share;
}

/// A cause with all values at which it is compared. `found` is the cause as the comparison before found
/// it, or null; what sets in may do so at each of `visits`.
std::vector<Regressor> tried_of(const CauseId& cause, const SizedCause* found,
                                const std::vector<int>& visits, const CausePrior& prior) {
  const Effect& effect = *cause.effect;
  const std::size_t parameters = effect.parameters.size();
  const bool known = found != nullptr;
  std::vector<int> set_in = parameters > 1 ? thinned(visits) : std::vector<int>{0};
  Regressor own{known ? *found : SizedCause{cause, nominal_values(effect)}};
  if (known && parameters > 1)
    append_all(set_in, about(visits, static_cast<int>(own.values.back())));
  sort_unique(set_in);
  own.expected = effect.expected > 0.0;
  const double share =
      share_of(effect, prior) / as_double(effect.sides.size()) / as_double(set_in.size());
  std::vector<Regressor> tried;
  const auto add = [&](bool refined, double of_value) {
    own.refined = refined;
    own.log_prior = std::log(share * of_value);
    tried.push_back(own);
  };
  for (const int visit : set_in) {
    if (parameters > 1) own.values.back() = visit;
    if (effect.parameters.front().integer) {
      for (const Teeth& one : kTeeth) {
        own.values.front() = one.teeth;
        add(false, one.share);
      }
    } else if (parameters < 3) {
      add(known, 1.0);
    } else {
      if (known) {
        own.values[1] = found->values[1];
        add(true, 1.0 / (kWays + 1));
      }
      for (const int way : each_below(kWays)) {
        own.values[1] =
            std::remainder(2.0 * std::numbers::pi * way / kWays, 2.0 * std::numbers::pi);
        add(false, 1.0 / kWays);
      }
    }
  }
  return tried;
}

/// Columns of one cause. From its first visit on a column does not depend on that visit, so one
/// evaluation serves all visits.
ColumnOf columns_of(const MeasuredBelts& belts, const FrameState& state,
                    const RegressorSystem& system) {
  return [&, from_the_start = std::map<std::vector<double>, VectorXd>()](SizedCause cause) mutable {
    if (cause.values.size() == 1) return column_of(belts, state, system, cause);
    const double visit = std::exchange(cause.values.back(), std::numeric_limits<int>::min());
    VectorXd& whole = from_the_start[cause.values];
    if (whole.size() == 0) whole = column_of(belts, state, system, cause);
    VectorXd column = whole;
    for (const auto u : each_index(system.units)) {
      const SystemUnit& unit = system.units[u];
      if (system.places[u].order < visit) column.segment(unit.first_row, unit.rows).setZero();
    }
    return column;
  };
}

}  // namespace

Candidates candidates(const MeasuredBelts& belts) {
  const bool ordered = !visits_to_set_in(belts).empty();
  const auto some_are = [&belts](bool pulled) {
    return any_of(belts.points, [pulled](const BeltPoint& point) {
      return any_of(kBelts, [&](Belt belt) { return is_pulled(point, belt) == pulled; });
    });
  };
  const bool tells_pull = some_are(true) && some_are(false);
  const auto hidden_because = [&](const Effect* effect, EffectSide side) {
    if (effect == &model::belts::anchor_moved && side == EffectSide::all)
      return "moving the whole frame with its places changes no length: measure from two edges of "
             "the sheet to a hole that the machine cut";
    if (effect == &model::belts::belt_scale && side == EffectSide::all)
      return "lengths that are all too long in proportion fit a larger frame without "
             "contradiction: tape one long distance, between two anchors or two holes that the "
             "machine cut, and enter it under distances";
    if (effect->needs == DataNeed::order && !ordered)
      return "the file does not have the order of the places: add order";
    if (effect->by_tension && !tells_pull)
      return "no belt is pulled while others hold: name the pulled belts under pulled";
    return "";
  };
  Candidates result;
  for (const Effect* effect : model::belts::belt_effects()) {
    for (const EffectSide side : effect->sides) {
      const CauseId cause{effect, side};
      const std::string reason = hidden_because(effect, side);
      if (reason.empty()) {
        result.testable.push_back(cause);
      } else {
        result.not_testable.push_back({cause, reason});
      }
    }
  }
  return result;
}

namespace {

/// `index` numbers the file's points.
SystemPlace place_of(const MeasuredBelts& belts, const FrameState& state, std::size_t index) {
  const BeltPoint& point = belts.points[index];
  const FramePoint where = state.places[index];
  const BeltMachine frame = with_anchors(belts.machine, state.anchors);
  SystemPlace place;
  place.place = index;
  place.mark = {where.x_mm, where.y_mm};
  place.order = point.order.value_or(0);
  place.ordered = point.order.has_value();
  for (const Belt belt : kBelts) {
    place.length_mm.push_back(point.lengths_mm[belt]);
    place.angle_rad.push_back(std::atan2(std::abs(where.y_mm - frame.anchors[belt].y_mm),
                                         std::abs(where.x_mm - frame.anchors[belt].x_mm)));
  }
  return place;
}

}  // namespace

RegressorSystem system_of(const MeasuredBelts& belts, const FrameState& state,
                          const ObservationSet& session, const std::vector<CauseId>& causes,
                          const std::vector<SizedCause>& known) {
  // Two rows more than anchors are needed; otherwise no degrees of freedom remain.
  constexpr Index kFewestChecks = 3;
  // Two bad readings at a place, or at neighbouring places, can mask each other.
  constexpr std::size_t kBeyondTheBest = 8;
  RegressorSystem system = linearise(session, stated_state(session)).value();
  bool ordered = false;
  system.groups.clear();
  for (const auto u : each_index(system.units)) {
    SystemUnit& unit = system.units[u];
    for (const Index belt : each_below(4))
      system.groups.push_back({unit.first_row, 2, Vector2d(unit.by_reading.col(belt))});
    unit.places.push_back({u, {}});
    system.places.push_back(place_of(belts, state, session.units[u].index));
    ordered = ordered || system.places[u].ordered;
  }
  system.noise_dof = kNoiseDof;
  system.limits = {.fewest_rows = kAnchorUnknowns + kFewestChecks,
                   .beyond_the_best = kBeyondTheBest};
  system.prior = prior_of_belts();
  system.discrepancies = &length_discrepancies(ordered);
  system.g = RegressorColumns(system.e.size());
  const std::vector<int> visits = visits_to_set_in(belts);
  for (const CauseId& cause : causes) {
    const SizedCause* found = find_where(known, having(&SizedCause::cause, cause));
    const ColumnOf column = columns_of(belts, state, system);
    for (Regressor& own : tried_of(cause, found, visits, system.prior))
      add_regressor(std::move(own), column, system);
  }
  for (Regressor& own : system.regressors) {
    if (own.fixed) continue;
    // From the spread of the size, so that a hard-to-see zero does not become likelier.
    const double spread = own.cause.effect->parameters.front().prior_sigma /
                          std::max(std::abs(own.values.front()), 1e-12);
    own.coefficient_sigma = std::pow(spread, own.power);
  }
  return system;
}

VectorXd column_of(const MeasuredBelts& belts, const FrameState& state,
                   const RegressorSystem& system, const SizedCause& cause) {
  const VectorXd added = added_by(belts, {cause}, state);
  VectorXd column(system.e.size());
  for (const auto u : each_index(system.units)) {
    const SystemUnit& unit = system.units[u];
    column.segment(unit.first_row, unit.rows) =
        unit.by_reading * added.segment<4>(belts::row_of(system.places[u].place, Belt::tl));
  }
  return column;
}

}  // namespace chaintrue::grid::diagnosis
