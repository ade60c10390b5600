// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/regressors.hpp"

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/law_curves.hpp"
#include "grid/plane_vectors.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kMostLinks = 3;  // larger ones are visible to the eye

/// The predicted readings of a machine in this state, all rows.
std::optional<VectorXd> predicted(const ObservationSet& session, const State& state) {
  VectorXd all(session.rows);
  for (const ObservationPart& part : session.parts) {
    const auto own = part.observation->predicted(state.view(part));
    if (!own) return std::nullopt;
    all.segment(part.first_row, own->size()) = *own;
  }
  return all;
}

/// What an effect adds to the chains at a place, or to the written readings there.
Vector2d added_at(const SystemPlace& place, const model::Sprocket& sprocket, CauseId cause,
                  const std::vector<double>& values) {
  Vector2d mm = Vector2d::Zero();
  if (cause.effect->station == Station::reading && !place.ordered) return mm;
  const model::Pose& pose = place.state.reading.pose;
  for (const Side side : kSides) {
    if (!model::effects::acts_on(cause.side, side)) continue;
    model::effects::LengthState chain = model::effects::chain_at_rest(pose, side, sprocket);
    chain.order = place.order;
    mm(row_of(side)) = cause.effect->add(chain, values).value;
  }
  return mm;
}

/// The whitened column of an effect that is added to a chain or to the written reading: the poses
/// are unchanged.
VectorXd added(const RegressorSystem& system, const model::Sprocket& sprocket, CauseId cause,
               const std::vector<double>& values) {
  const auto mm = mapped(system.places, [&](const SystemPlace& place) {
    return added_at(place, sprocket, cause, values);
  });
  VectorXd column = VectorXd::Zero(system.e.size());
  for (const SystemUnit& unit : system.units) {
    for (const PlaceColumns& place_columns : unit.places) {
      column.segment(unit.first_row, unit.rows) += place_columns.by_chain * mm[place_columns.place];
    }
  }
  return column;
}

/// Whitened columns of effects about one state, whose own readings are predicted once.
struct Signatures {
  const ObservationSet& session;
  const State& state;
  const RegressorSystem& system;
  std::optional<VectorXd> without{};

  /// As signature().
  std::optional<VectorXd> operator()(const SizedCause& sized) {
    const auto& [cause, values] = sized;
    if (session.is_of_chains() && cause.effect->add != nullptr && !cause.effect->by_direction)
      return added(system, state.machine().sprocket, cause, values);
    const AppliedEffect own = applied(*cause.effect, cause.side, values);
    if (!state.mechanism->problems_of_effects({own}).empty()) return std::nullopt;
    const auto with = predicted(session, {state.mechanism->with_effects({own}), state.sheets});
    if (with && !without) without = predicted(session, state);
    if (!with || !without) return std::nullopt;
    return whitened(system, *with - *without);
  }
};

/// Continues through zero as a straight line: an odd effect changes its sign.
bool is_odd(const Regressor& regressor) { return regressor.power < 1.5; }

class Builder {
 public:
  Builder(const ObservationSet& session, const State& state, RegressorSystem& system)
      : system_(system), signatures_{session, state, system} {}

  void add(CauseId cause, const std::vector<SizedCause>& known) {
    std::vector<double> values = nominal_values(*cause.effect);
    const SizedCause* found = find_where(known, having(&SizedCause::cause, cause));
    refined_ = found != nullptr;
    if (refined_) values.front() = found->values.front();
    if (cause.effect->parameters.front().integer) {
      add_links(cause, values);
    } else if (place_parameter(*cause.effect) == nullptr) {
      add_one(cause, values, std::log(share_of_side(cause)));
    } else {
      if (has_step(*cause.effect)) return add_steps(cause, values);
      const std::vector<double> where = places_to_set_in(system_, cause);
      const double share = std::log(share_of_side(cause) / as_double(where.size()));
      for (const double place : where) {
        values.back() = place;
        add_one(cause, values, share);
      }
      // All visits are among the places already.
      if (refined_ && !place_parameter(*cause.effect)->integer)
        add_one(cause, found->values, share);
    }
  }

 private:
  static double share_of_side(CauseId cause) { return 1.0 / as_double(cause.effect->sides.size()); }

  void add_one(CauseId cause, const std::vector<double>& values, double log_prior) {
    Regressor regressor{{cause, values}};
    regressor.log_prior = log_prior;
    regressor.refined = refined_;
    add_regressor(std::move(regressor), std::ref(signatures_), system_);
  }

  /// A step lies in a gap between two places of the tool, with probability proportional to its
  /// width.
  void add_steps(CauseId cause, std::vector<double> values) {
    const EffectParameter& place = *place_parameter(*cause.effect);
    const PlaceVariable variable = variable_of_place(*cause.effect, place);
    std::vector<double> there = compared_at_places(system_, variable, cause.side);
    if (there.size() < 2) return;
    sort(there);
    const double from = std::max(place.lower, there.front());
    const double to = std::min(place.upper, there.back());
    if (!(from < to)) return;
    const StepPlaces where = step_places(there, from, to);
    for (const auto k : each_index(where.at)) {
      values.back() = where.at[k];
      add_one(cause, values, std::log(share_of_side(cause) * where.mass[k]));
    }
  }

  /// A misreading of k links is k times that of one.
  void add_links(CauseId cause, std::vector<double> values) {
    const std::vector<double> where = places_to_set_in(system_, cause);
    for (const double place : where) {
      values.back() = place;
      values.front() = 1.0;
      const auto one = signatures_({cause, values});
      if (!one || !(one->norm() > 0.0)) continue;
      for (int links = -kMostLinks; links <= kMostLinks; ++links) {
        if (links == 0) continue;
        values.front() = links;
        Regressor regressor{{cause, values}};
        regressor.fixed = true;
        regressor.slip = cause.effect->at_one_visit;
        regressor.lowest = regressor.highest = 1.0;
        regressor.visits = as_double(where.size());
        system_.regressors.push_back(std::move(regressor));
        if (links == -kMostLinks) {
          system_.g.add(*one, links);
        } else {
          system_.g.add_multiple(links);
        }
      }
    }
  }

  RegressorSystem& system_;
  Signatures signatures_;
  bool refined_ = false;
};

/// Why none of the observations can show this cause; empty if one can.
std::string untestable(const ObservationSet& session, CauseId cause) {
  std::string reason;
  for (const ObservationPart& part : session.parts) {
    if (!part.observation->may_be_outlier()) continue;
    const std::string own = part.observation->untestable(*cause.effect, cause.side);
    if (own.empty()) return "";
    if (reason.empty()) reason = own;
  }
  return reason;
}

}  // namespace

Candidates candidates(const ObservationSet& session) {
  Candidates result;
  for (const Effect* effect : session.mechanism->effects()) {
    for (const EffectSide side : effect->sides) {
      const CauseId cause{effect, side};
      const auto problems = session.mechanism->problems_of_effects(
          {applied(*effect, side, nominal_values(*effect))});
      const std::string reason = untestable(session, cause);
      if (!reason.empty()) {
        result.not_testable.push_back({cause, reason});
      } else if (!problems.empty()) {
        result.not_testable.push_back({cause, problems.front().expected});
      } else {
        result.testable.push_back(cause);
      }
    }
  }
  return result;
}

std::optional<VectorXd> signature(const ObservationSet& session, const State& state,
                                  const RegressorSystem& system, const SizedCause& cause) {
  // Columns for belts are derivatives at a frame (belts_system.cpp), not at a state.
  if (!state.mechanism) return std::nullopt;
  return Signatures{session, state, system}(cause);
}

void add_regressors(const ObservationSet& session, const State& state,
                    const std::vector<CauseId>& causes, const std::vector<SizedCause>& known,
                    RegressorSystem& system) {
  if (system.g.cols() == 0) system.g = RegressorColumns(session.rows);
  Builder builder(session, state, system);
  for (const CauseId& cause : causes) builder.add(cause, known);
  system.g.fit();
}

bool renew_regressors(const ObservationSet& session, const State& state,
                      const std::vector<Regressor>& regressors, RegressorSystem& system) {
  system.regressors.clear();
  system.g = RegressorColumns(session.rows);
  const ColumnOf column = Signatures{session, state, system};
  return all_of(regressors, [&](Regressor own) {
    own.refined = !own.fixed;
    return add_regressor(std::move(own), column, system);
  });
}

double size_at(const Regressor& regressor, double coefficient) {
  const double at = regressor.values.front();
  if (regressor.fixed) return at;
  if (coefficient <= 0.0) return is_odd(regressor) ? at * coefficient : 0.0;
  return at * std::pow(coefficient, 1.0 / regressor.power);
}

double size_slope(const Regressor& regressor, double coefficient) {
  if (regressor.fixed) return 0.0;
  const double at = regressor.values.front();
  if (coefficient <= 0.0 && is_odd(regressor)) return at;
  const double c = std::max(coefficient, 1e-6);
  return at / regressor.power * std::pow(c, 1.0 / regressor.power - 1.0);
}

namespace {

/// Share of a size, for difference quotients.
constexpr double kNearby = 0.95;

/// The coefficient's power: the growth of the signature from half the size to the whole.
double power_of(const VectorXd& whole, const VectorXd& half) {
  const double ratio = whole.norm() / std::max(half.norm(), 1e-300);
  return std::max(1.0, std::round(std::log2(ratio)));
}

/// As above about a fitted size, with `nearby` at kNearby of it. A signature that hardly grows does
/// not determine its size; one that shrinks has no power.
double power_about(const VectorXd& whole, const VectorXd& nearby) {
  const double ratio = whole.dot(nearby) / whole.squaredNorm();
  return std::clamp(std::log(std::max(ratio, 1e-3)) / std::log(kNearby), 0.2, 4.0);
}

/// Sets the coefficient's range from that of the size.
void limit(Regressor& regressor) {
  const EffectParameter& size = regressor.cause.effect->parameters.front();
  const double at = regressor.values.front();
  const auto coefficient = [&](double bound) {
    const double ratio = bound / at;
    return ratio < 0.0 ? -std::pow(-ratio, regressor.power) : std::pow(ratio, regressor.power);
  };
  const double a = coefficient(size.lower);
  const double b = coefficient(size.upper);
  regressor.lowest = std::min(a, b);
  regressor.highest = std::max(a, b);
}

}  // namespace

bool add_regressor(Regressor regressor, const ColumnOf& column, RegressorSystem& system) {
  const auto g = column(regressor);
  if (!g || !(g->norm() > 0.0)) return false;
  if (regressor.cause.effect->parameters.front().integer) {
    regressor.fixed = true;
    regressor.lowest = regressor.highest = 1.0;
  } else {
    SizedCause smaller = regressor;
    smaller.values.front() *= regressor.refined ? kNearby : 0.5;
    const auto there = column(smaller);
    if (!there) return false;
    regressor.power = regressor.refined ? power_about(*g, *there) : power_of(*g, *there);
    limit(regressor);
  }
  system.regressors.push_back(std::move(regressor));
  system.g.add(*g);
  return true;
}

}  // namespace chaintrue::grid::diagnosis
