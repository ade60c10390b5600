// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/regressor_system.hpp"

#include <cmath>
#include <numbers>

#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Sigma of a parameter without a stated one, in its unit: a metre is practically no prior.
constexpr double kOpenSigma = 1000.0;

}  // namespace

tl::expected<RegressorSystem, observation::Unreachable> linearise(const ObservationSet& set,
                                                                  const State& state) {
  std::vector<estimation::ObservedFrom> from;
  for (const ObservationPart& part : set.parts) {
    const auto settings = std::ssize(set.columns_of(part));
    from.push_back({state.view(part), VectorXd::Zero(settings)});
  }
  auto line = estimation::linearise(set, from, estimation::Prediction::visit_by_visit);
  if (!line) {
    const estimation::PlaceOfObservation& where = line.error().place;
    return tl::unexpected(line.error().at(set.parts[where.observation].first_place + where.place));
  }
  RegressorSystem system;
  static_cast<estimation::LinearisedSystem&>(system) = *std::move(line);
  for (const SystemUnit& unit : system.units) system.groups.push_back({unit.first_row, unit.rows});
  system.setting = setting_values(set, state);
  system.expected_change = set.stated_value - system.setting;
  system.sigma = set.stated_sigma.unaryExpr(
      [](double sigma) { return std::isfinite(sigma) ? sigma : kOpenSigma; });
  // The shares of an effect's sides, places and numbers sum to one.
  system.prior.shares = as_double(state.mechanism->effects().size());
  system.noise_dof = set.noise_dof;
  system.limits.fewest_groups = set.fewest_units;
  return system;
}

namespace {

constexpr int kPlaces = 24;  // of a knee or a phase: neighbours have a collinearity of 0.99

/// The value that an effect's place is compared with, at one place of the tool.
double compared(const SystemPlace& own, PlaceVariable variable, Side side) {
  const model::Pose& pose = own.state.reading.pose;
  const model::ChainState& chain = pose.chains[side];
  switch (variable) {
    case PlaceVariable::visit:
      return own.order;
    case PlaceVariable::free_length:
      return chain.free_length_mm;
    case PlaceVariable::length:
      return pose.lengths[side];
    case PlaceVariable::tension:
      return chain.tension_at_sprocket_n;
    case PlaceVariable::horizontal:
      return chain.horizontal_n;
    case PlaceVariable::x:
      return pose.position.x_mm;
    case PlaceVariable::y:
      return pose.position.y_mm;
    case PlaceVariable::distance:
      return std::hypot(pose.position.x_mm, pose.position.y_mm);
    default:
      return chain.angle_rad;
  }
}

std::vector<double> compared(const RegressorSystem& system, PlaceVariable variable, Side side) {
  std::vector<double> there;
  for (const SystemPlace& own : system.places) {
    if (variable != PlaceVariable::visit || own.ordered)
      there.push_back(compared(own, variable, side));
  }
  return there;
}

/// At most kPlaces, evenly by rank.
std::vector<double> evenly_by_rank(std::vector<double> there) {
  std::vector<double> result;
  sort(there);
  const auto last = as_double(there.size() - 1);
  for (const int k : each_below(kPlaces)) {
    const double at = last * k / kPlaces;
    const auto below = static_cast<std::size_t>(at);
    result.push_back(there[below] + (at - std::floor(at)) * (there[below + 1] - there[below]));
  }
  return result;
}

}  // namespace

const EffectParameter* place_parameter(const Effect& effect) {
  for (const EffectParameter& p : effect.parameters) {
    if (p.role == ParameterRole::place) return &p;
  }
  return nullptr;
}

PlaceVariable variable_of_place(const Effect& effect, const EffectParameter& place) {
  if (effect.law != nullptr) return place_variable(effect);
  if (place.integer) return PlaceVariable::visit;
  return place.upper - place.lower >= 2.0 * std::numbers::pi ? PlaceVariable::phase
                                                             : PlaceVariable::angle;
}

std::vector<double> compared_at_places(const RegressorSystem& system, PlaceVariable variable,
                                       EffectSide side) {
  std::vector<double> there;
  if (side != EffectSide::right) there = compared(system, variable, Side::left);
  if (side == EffectSide::left) return there;
  const std::vector<double> right = compared(system, variable, Side::right);
  append_all(there, right);
  return there;
}

std::vector<double> places_to_set_in(const RegressorSystem& system, CauseId cause) {
  const EffectParameter& place = *place_parameter(*cause.effect);
  std::vector<double> result;
  if (place.integer) {
    // A skip before the first visit is a zero; a miscount may be at any visit.
    for (const SystemPlace& own : system.places) {
      if (own.ordered) result.push_back(own.order);
    }
    if (!cause.effect->at_one_visit && !result.empty()) std::erase(result, *min_element(result));
    return result;
  }
  const PlaceVariable variable = variable_of_place(*cause.effect, place);
  if (variable == PlaceVariable::phase) {
    for (const int k : each_below(kPlaces)) {
      const double at = 2.0 * std::numbers::pi * k / kPlaces;
      result.push_back(at > place.upper ? at - 2.0 * std::numbers::pi : at);
    }
    return result;
  }
  if (variable == PlaceVariable::none) {
    for (const int k : each_below(kPlaces))
      result.push_back(place.lower + (place.upper - place.lower) * (k + 0.5) / kPlaces);
    return result;
  }
  const auto side = cause.side == EffectSide::left ? Side::left : Side::right;
  std::vector<double> there = compared(system, variable, side);
  if (there.size() < 2) return result;
  result = evenly_by_rank(std::move(there));
  if (cause.effect->law != nullptr) {
    std::erase_if(result, [&](double at) { return at < place.lower || at > place.upper; });
  }
  return result;
}

bool has_step(const Effect& effect) {
  const model::effects::Declaration* declared = declaration_of(effect);
  if (declared == nullptr || declared->adds_mm.find("step(") == std::string::npos) return false;
  const PlaceVariable of = variable_of_place(effect, *place_parameter(effect));
  return of != PlaceVariable::phase && of != PlaceVariable::none && of != PlaceVariable::visit;
}

std::optional<PlaceGap> gap_about(const RegressorSystem& system, CauseId cause, double place) {
  const PlaceVariable variable = variable_of_place(*cause.effect, *place_parameter(*cause.effect));
  if (variable == PlaceVariable::phase || variable == PlaceVariable::none) return std::nullopt;
  std::optional<double> below;
  std::optional<double> above;
  for (const double at : compared_at_places(system, variable, cause.side)) {
    if (at < place && (!below || at > *below)) below = at;
    if (at >= place && (!above || at < *above)) above = at;
  }
  if (!below || !above) return std::nullopt;
  return PlaceGap{*below, *above};
}

}  // namespace chaintrue::grid::diagnosis
