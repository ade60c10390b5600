// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_system.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "grid/diagnosis/discrepancy.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {

using model::Belt;
using model::kBelts;

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
constexpr Teeth kTeeth[] = {{1.0, 0.25},
                            {-1.0, 0.25},
                            {2.0, 0.1},
                            {-2.0, 0.1},
                            {3.0, 0.05},
                            {-3.0, 0.05},
                            {22.0, 0.1},
                            {-22.0, 0.1}};

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
  std::vector<int> few;
  for (std::size_t i = 0; i < kVisits; ++i) few.push_back(visits[i * visits.size() / kVisits]);
  return few;
}

/// The visits between the neighbours of one of the thinned visits.
std::vector<int> about(const std::vector<int>& visits, int visit) {
  const auto half = static_cast<std::ptrdiff_t>(visits.size() / kVisits + 1);
  const auto at = std::lower_bound(visits.begin(), visits.end(), visit) - visits.begin();
  const auto last = static_cast<std::ptrdiff_t>(visits.size());
  return {visits.begin() + std::clamp<std::ptrdiff_t>(at - half, 0, last),
          visits.begin() + std::clamp<std::ptrdiff_t>(at + half + 1, 0, last)};
}

/// The whitened rows of lengths that are added at the places of a system.
Eigen::VectorXd whitened_lengths(const RegressorSystem& system, const Eigen::VectorXd& added) {
  Eigen::VectorXd column(system.e.size());
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    column.segment(system.units[u].first_row, system.units[u].rows) =
        system.units[u].by_reading *
        added.segment<4>(belts::row_of(system.places[u].place, Belt::tl));
  }
  return column;
}

/// The lengths that one cause adds. From its first visit on they do not depend on that visit, so one
/// evaluation serves all visits.
class AddedLengths {
 public:
  AddedLengths(const MeasuredBelts& belts, const belts::FrameState& state)
      : belts_(belts), state_(state) {}

  [[nodiscard]] Eigen::VectorXd of(const SizedCause& cause) {
    if (cause.cause.effect->parameters.size() == 1) return added_by(belts_, {cause}, state_);
    SizedCause from_the_start = cause;
    from_the_start.values.back() = std::numeric_limits<int>::min();
    const auto [known, is_new] = known_.try_emplace(from_the_start.values);
    if (is_new) known->second = added_by(belts_, {from_the_start}, state_);
    Eigen::VectorXd added = known->second;
    for (std::size_t k = 0; k < belts_.points.size(); ++k) {
      if (belts_.points[k].order.value_or(0) < cause.values.back())
        added.segment<4>(belts::row_of(k, Belt::tl)).setZero();
    }
    return added;
  }

 private:
  const MeasuredBelts& belts_;
  const belts::FrameState& state_;
  std::map<std::vector<double>, Eigen::VectorXd> known_;
};

class Columns {
 public:
  Columns(const MeasuredBelts& belts,
          const belts::FrameState& state,
          const std::vector<SizedCause>& known,
          RegressorSystem& system)
      : belts_(belts),
        state_(state),
        known_(known),
        system_(system),
        visits_(visits_to_set_in(belts)) {}

  void add(const CauseId& cause) {
    added_.emplace(belts_, state_);
    const auto& parameters = cause.effect->parameters;
    const SizedCause* found =
        find_where(known_, [&cause](const SizedCause& own) { return own.cause == cause; });
    std::vector<double> values =
        found != nullptr ? found->values : model::effects::nominal_values(*cause.effect);
    const double side = share_of(cause) / as_double(cause.effect->sides.size());
    if (parameters.size() == 1) return add_one({cause, values}, found != nullptr, side);
    std::vector<int> visits = thinned(visits_);
    if (found != nullptr) {
      const std::vector<int> near = about(visits_, static_cast<int>(values.back()));
      append_all(visits, near);
      sort_unique(visits);
    }
    const double share = side / as_double(visits.size());
    for (const int visit : visits) {
      values.back() = visit;
      if (parameters.front().integer) {
        for (const Teeth& own : kTeeth) {
          values.front() = own.teeth;
          add_one({cause, values}, false, share * own.share);
        }
      } else if (parameters.size() > 2) {
        add_ways({cause, values}, found, share);
      } else {
        add_one({cause, values}, found != nullptr, share);
      }
    }
  }

 private:
  /// For an expected effect, the share that makes it alone as likely as no cause (CausePrior).
  [[nodiscard]] double share_of(const CauseId& cause) const {
    const Effect& effect = *cause.effect;
    if (!(effect.expected > 0.0)) return effect.share;
    return effect.expected * system_.prior.shares * kPriorOfNothing / kPriorOfOne;
  }

  void add_ways(SizedCause own, const SizedCause* found, double share) {
    if (found != nullptr) {
      own.values[1] = found->values[1];
      add_one(own, true, share / (kWays + 1));
    }
    for (int way = 0; way < kWays; ++way) {
      own.values[1] = std::remainder(2.0 * std::numbers::pi * way / kWays, 2.0 * std::numbers::pi);
      add_one(own, false, share / kWays);
    }
  }

  void add_one(const SizedCause& own, bool refined, double share) {
    const Eigen::VectorXd column = whitened_lengths(system_, added_->of(own));
    if (!(column.norm() > 0.0)) return;
    Regressor regressor;
    regressor.cause = own.cause;
    regressor.values = own.values;
    regressor.log_prior = std::log(share);
    regressor.refined = refined;
    regressor.expected = own.cause.effect->expected > 0.0;
    if (own.cause.effect->parameters.front().integer) {
      regressor.fixed = true;
      regressor.lowest = regressor.highest = 1.0;
    } else {
      SizedCause smaller = own;
      smaller.values.front() *= refined ? kNearby : 0.5;
      const Eigen::VectorXd other = whitened_lengths(system_, added_->of(smaller));
      regressor.power = refined ? power_about(column, other) : power_of(column, other);
      limit(regressor);
      regressor.coefficient_sigma = sigma_of(regressor);
    }
    system_.regressors.push_back(std::move(regressor));
    system_.g.add(column);
  }

  /// Prior sigma of the coefficient, from the spread of the size, so that a hard-to-see zero does
  /// not become likelier.
  [[nodiscard]] static double sigma_of(const Regressor& regressor) {
    const double ratio = regressor.cause.effect->parameters.front().prior_sigma /
                         std::max(std::abs(regressor.values.front()), 1e-12);
    return std::pow(ratio, regressor.power);
  }

  const MeasuredBelts& belts_;
  const belts::FrameState& state_;
  const std::vector<SizedCause>& known_;
  RegressorSystem& system_;
  std::vector<int> visits_;
  std::optional<AddedLengths> added_;
};

}  // namespace

Candidates candidates(const MeasuredBelts& belts) {
  const bool ordered = !visits_to_set_in(belts).empty();
  std::array<bool, 2> is_pulled_anywhere{};
  for (const BeltPoint& point : belts.points) {
    for (const Belt belt : kBelts) is_pulled_anywhere[is_pulled(point, belt) ? 1 : 0] = true;
  }
  const bool tells_pull = is_pulled_anywhere[0] && is_pulled_anywhere[1];
  const auto hidden_because = [&](const Effect* effect, EffectSide side) {
    if (effect == &model::belts::anchor_moved && side == EffectSide::all)
      return "moving the whole frame with its places changes no length: measure from two edges of "
             "the sheet to a hole that the machine cut";
    if (effect == &model::belts::belt_scale && side == EffectSide::all)
      return "lengths that are all too long in proportion fit a larger frame without "
             "contradiction: tape one long distance, between two anchors or two holes that the "
             "machine cut, and enter it under distances";
    if (effect->needs == model::effects::DataNeed::order && !ordered)
      return "the file does not have the order of the places: add order";
    if ((effect == &model::belts::belt_stretch || effect == &model::belts::anchor_flex) &&
        !tells_pull)
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
SystemPlace place_of(const MeasuredBelts& belts,
                     const belts::FrameState& state,
                     std::size_t index) {
  const BeltPoint& point = belts.points[index];
  const model::FramePoint where = state.places[index];
  const model::BeltMachine frame = belts::with_anchors(belts.machine, state.anchors);
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

ObservationSet observations_of(const MeasuredBelts& belts,
                               const belts::FrameState& state,
                               double sigma_mm) {
  return observations_of(
      belts, state, belts::Counting(belts.points.size(), belts::kAllBelts), sigma_mm);
}

RegressorSystem system_of(const MeasuredBelts& belts,
                          const belts::FrameState& state,
                          const ObservationSet& session,
                          const std::vector<CauseId>& causes,
                          const std::vector<SizedCause>& known) {
  // Two rows more than anchors are needed; otherwise no degrees of freedom remain.
  constexpr Eigen::Index kFewestChecks = 3;
  // Two bad readings at a place, or at neighbouring places, can mask each other.
  constexpr std::size_t kBeyondTheBest = 8;
  RegressorSystem system = linearise(session, estimation::stated_state(session)).value();
  bool ordered = false;
  for (std::size_t u = 0; u < system.units.size(); ++u) {
    SystemUnit& unit = system.units[u];
    for (Eigen::Index belt = 0; belt < 4; ++belt)
      system.groups.push_back({unit.first_row, 2, Eigen::Vector2d(unit.by_reading.col(belt))});
    unit.places.push_back({u, {}});
    system.places.push_back(place_of(belts, state, session.units[u].index));
    ordered = ordered || system.places[u].ordered;
  }
  system.noise_dof = kNoiseDof;
  system.limits = {.fewest_rows = belts::kAnchorUnknowns + kFewestChecks,
                   .beyond_the_best = kBeyondTheBest};
  system.prior = prior_of_belts();
  system.discrepancies = &length_discrepancies(ordered);
  system.g = RegressorColumns(system.e.size());
  Columns columns(belts, state, known, system);
  for (const CauseId& cause : causes) columns.add(cause);
  return system;
}

Eigen::VectorXd column_of(const MeasuredBelts& belts,
                          const belts::FrameState& state,
                          const RegressorSystem& system,
                          const SizedCause& cause) {
  return whitened_lengths(system, added_by(belts, {cause}, state));
}

}  // namespace chaintrue::grid::diagnosis
