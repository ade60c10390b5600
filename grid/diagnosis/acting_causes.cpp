// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/acting_causes.hpp"

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/regressor_places.hpp"

namespace chaintrue::grid::diagnosis {

using model::effects::EffectParameter;
using model::effects::PlaceVariable;

namespace {

bool has_order(const MeasuredFile& file) {
  const MeasuredGrid* grid = file.grid();
  return grid != nullptr &&
         all_of(grid->points, [](const MeasuredPoint& point) { return point.order.has_value(); });
}

}  // namespace

const ParameterEstimate* unsure_place(const Cause& cause) {
  const model::effects::Effect& effect = *cause.cause.effect;
  const EffectParameter* place = place_parameter(effect);
  if (place == nullptr || place->integer) return nullptr;
  const PlaceVariable of = variable_of_place(effect, *place);
  if (of == PlaceVariable::none || of == PlaceVariable::phase || of == PlaceVariable::visit) return nullptr;
  for (const ParameterEstimate& p : cause.parameters) {
    if (p.parameter == place->name) return p.sigma > 0.0 ? &p : nullptr;
  }
  return nullptr;
}

model::AppliedEffect applied_at(const Cause& cause, const ParameterEstimate& place, double off, double share) {
  const EffectParameter& bounds = *place_parameter(*cause.cause.effect);
  const EffectParameter& size = cause.cause.effect->parameters.front();
  model::AppliedEffect effect = applied(cause);
  effect.parameters[place.parameter] = std::clamp(place.value + off, bounds.lower, bounds.upper);
  double& own = effect.parameters[std::string(size.name)];
  own = size.null + share * (own - size.null);
  return effect;
}

model::AppliedEffect applied(const Cause& cause) {
  model::AppliedEffect effect{
      std::string(cause.cause.effect->id), std::string(model::effects::name(cause.cause.side)), {}};
  for (const ParameterEstimate& p : cause.parameters) effect.parameters[p.parameter] = p.value;
  return effect;
}

std::vector<model::AppliedEffect> applied_over_places(const Cause& cause) {
  const ParameterEstimate* place = unsure_place(cause);
  if (place == nullptr) return {applied(cause)};
  constexpr int kPlaces = 9;  // a ninth of a gap between marks: less than a surface of these marks can show
  std::vector<model::AppliedEffect> effects;
  for (int k = 0; k < kPlaces; ++k) {
    const double off = std::sqrt(3.0) * place->sigma * ((2.0 * k + 1.0) / kPlaces - 1.0);
    effects.push_back(applied_at(cause, *place, off, 1.0 / kPlaces));
  }
  return effects;
}

std::vector<ActingCause> over_places(const std::vector<Cause>& causes) {
  std::vector<ActingCause> acting;
  for (const Cause& cause : causes) acting.push_back({cause, applied_over_places(cause)});
  return acting;
}

Measured with_effects(const Measured& measured, const std::vector<ActingCause>& causes) {
  Measured changed;
  bool is_before_visits = true;
  for (MeasuredFile file : measured.files()) {
    const bool has_visits = is_before_visits && has_order(file);
    is_before_visits = is_before_visits && !has_visits;
    std::visit(
        [&](auto& own) {
          if (!own.machine) return;
          auto& effects = own.machine->effects;
          for (const ActingCause& acting : causes) {
            if (has_visits || !model::effects::depends_on_visit(*acting.cause.cause.effect))
              append_all(effects, acting.effects);
          }
        },
        file.measured);
    changed.add(std::move(file));
  }
  return changed;
}

}  // namespace chaintrue::grid::diagnosis
