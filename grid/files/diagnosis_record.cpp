// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/diagnosis_record.hpp"

#include <fmt/format.h>

#include "grid/containers.hpp"
#include "grid/files/record_values.hpp"
#include "grid/files/records.hpp"
#include "model/belts/belt_effects.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::files {

namespace {

/// The effect that the extended machine declares, or else that of chains, of belts or of cords, in this
/// order.
Value<const Effect*> effect_word() {
  std::vector<std::pair<std::string, const Effect*>> names;
  for (const Effect* effect : model::effects::catalogue()) names.emplace_back(effect->id, effect);
  for (const auto table : {model::belts::belt_effects(), model::plotter::plotter_effects()}) {
    for (const Effect* effect : table)
      if (model::effects::find_effect(effect->id) == nullptr)
        names.emplace_back(effect->id, effect);
  }
  const auto known = choice_of<const Effect*>(std::move(names));
  return {
      [known](const Cursor& at) -> std::optional<const Effect*> {
        const Effect* declared = at.json().is_string()
                                     ? declared_in_document(at, at.json().get<std::string>())
                                     : nullptr;
        return declared != nullptr ? std::optional(declared) : known.read(at);
      },
      [](const Effect* const& effect) { return effect->id; },
      // Declared effects have their own names.
      {known.expected.words, {{"type", "string"}, {"examples", known.expected.schema["enum"]}}}};
}

bool acts_at(const Effect& effect, EffectSide side) { return contains(effect.sides, side); }

bool is_of_a_drawing(const Json& root) {
  const auto what = root.find("observations");
  return what != root.end() && *what == "drawing";
}

/// The cause of an object, or the object itself.
template <class T>
auto& cause_in(T& object) {
  if constexpr (std::is_same_v<T, CauseId>) {
    return object;
  } else {
    return object.cause;
  }
}
template <class T, class M>
auto path_of_cause(M CauseId::*member) {
  if constexpr (std::is_same_v<T, CauseId>) {
    return member;
  } else {
    return path(&T::cause, member);
  }
}

/// The keys of an effect and its side.
template <class T>
void cause_keys(Record<T>& record) {
  record.required("effect", "The effect's name, as chaintrue effects lists them.",
                  path_of_cause<T>(&CauseId::effect), effect_word());
  record.nullable("side", "Where it acts; null for effects without a side.",
                  path_of_cause<T>(&CauseId::side), by_name_to(EffectSide::all));
  record.check([](const Cursor& at, T& object) {
    if (!at.child("effect").clean() || !at.child("side").clean()) return;
    CauseId& found = cause_in(object);
    if (found.effect == nullptr) return;
    // Chains, belts and cords have drift and skips: a drawing is of cords, and the side decides between
    // the others.
    const bool of_cords = is_of_a_drawing(at.root());
    if (!of_cords && acts_at(*found.effect, found.side)) return;
    const Effect* other = model::effects::find_effect(
        of_cords ? model::plotter::plotter_effects() : model::belts::belt_effects(),
        found.effect->id);
    if (other != nullptr) found.effect = other;
    if (!acts_at(*found.effect, found.side))
      at.child("side").expect(fmt::format("a side on which {} acts", found.effect->id));
  });
}

}  // namespace

RECORD_OF(CauseId, "an effect with its side")
ALSO(cause_keys)
END_RECORD;

namespace {

auto estimate_record() {
  RECORD(ParameterEstimate, "a value with its sigma")
  REQUIRED(value, "The value.")
  REQUIRED(sigma, "Its uncertainty, 1 sigma.", kNotNegative);
}

/// An object with one key for each parameter, in the order of the effect's parameters.
template <class T>
void parameter_keys(Record<T>& record) {
  record.custom(
      "parameters", "Its size and other parameters, each with its sigma.", true,
      {"an object, each value a value with its sigma",
       dictionary_schema(estimate_record().schema())},
      [](const Cursor& at, T& object) {
        if (!at.json().is_object())
          return (void)at.expect("an object, each value a value with its sigma");
        for (const auto& [key, unused] : at.json().items()) {
          if (key == "comment") continue;
          if (auto estimate = estimate_record().read(at.child(key))) {
            estimate->parameter = key;
            object.parameters.push_back(std::move(*estimate));
          }
        }
      },
      [](const T& object) {
        Json json = Json::object();
        for (const ParameterEstimate& estimate : object.parameters) {
          json[estimate.parameter] = estimate_record().write(estimate);
        }
        return json;
      });
  record.check([](const Cursor& at, T& object) {
    if (object.cause.effect == nullptr || !at.child("parameters").clean()) return;
    Words names;
    for (const auto& parameter : object.cause.effect->parameters)
      names.emplace_back(parameter.name);
    for (const ParameterEstimate& estimate : object.parameters) {
      if (!contains(names, estimate.parameter)) {
        at.child("parameters")
            .child(estimate.parameter)
            .report(estimate.parameter, ProblemKind::unknown_word,
                    fmt::format("a parameter of {}: {}", object.cause.effect->id, joined(names)));
      }
    }
  });
}

RECORD_OF(diagnosis::SameCause, "a cause of the same class")
ALSO(cause_keys)
ALSO(parameter_keys)
END_RECORD;

/// The effect that is hardest to distinguish from a cause with these data.
struct Rival {
  CauseId cause;
  double collinearity = 0.0;
};

auto rival_record() {
  RECORD(Rival, "a rival")
  ALSO(cause_keys)
  NAMED(required, "rho", collinearity,
        "Collinearity of its signature with the cause's: 0 different, 1 the same.", kShare);
}

}  // namespace

RECORD_OF(Cause, "a cause")
ALSO(cause_keys)
REQUIRED(probability, "Its probability.", kShare)
NAMED(required, "delta", signal_to_noise, "Signal-to-noise ratio.", kNotNegative)
REQUIRED(share_left, "Share of its signature that the settings do not absorb.", kShare)
REQUIRED(same_as, "Causes that such data cannot distinguish from it, with their sizes.")
ALSO(parameter_keys)
FIELD(
    computed, "rival", "The effect that is hardest to distinguish from it in these data.", false,
    object(rival_record()),
    [](Cause& object, const Rival& rival) {
      object.rival = rival.cause;
      object.rival_collinearity = rival.collinearity;
    },
    [](const Cause& object) {
      return object.rival ? rival_record().write({*object.rival, object.rival_collinearity})
                          : Json(nullptr);
    })
REQUIRED(order_assumed, "It needs the order of the visits, which was not recorded.")
END_RECORD;

Record<Hypothesis> hypothesis_record() {
  RECORD(Hypothesis, "a hypothesis")
  // Two effects at once are written as "first + second", and their sides likewise.
  REQUIRED(effect,
           "An effect's name, or nothing, unknown, noise, bad_points; two together "
           "are written first + second.")
  NULLABLE(side, "Its side, or both sides equally.")
  REQUIRED(probability, "Its probability.", kShare);
}

RECORD_OF(LeftOver, "what remains")
NAMED(required, "delta", signal_to_noise, "Signal-to-noise ratio.", kNotNegative)
NULLABLE(follows,
         "What it depends on: an angle, a length, a tension, the order, x, y; null: none of them.")
REQUIRED(share, "Share of the whole.", kShare)
REQUIRED(p_value, "How often noise alone gives as much.", kShare)
END_RECORD;

RECORD_OF(NotTestable, "an effect that could not be tested")
ALSO(cause_keys)
REQUIRED(reason, "The reason.")
END_RECORD;

RECORD_OF(Bound, "a bound")
ALSO(cause_keys)
REQUIRED(parameter, "The parameter of the effect.")
REQUIRED(upper_95, "Upper limit with 95 % probability.", kNotNegative)
END_RECORD;

RECORD_OF(DeclaredAnswer, "an answer")
ALSO(cause_keys)
REQUIRED(says,
         "confirmed: named at 90 % or more; denied: at most 10 %, although it would have shown "
         "at its declared size; open: neither; not_testable: these readings cannot show it.",
         by_name_to(DeclaredAnswer::Says::not_testable))
REQUIRED(probability, "Probability that it acts.", kShare)
END_RECORD;

RECORD_OF(CalibratedSetting, "a setting")
REQUIRED(setting, "Name of the setting.", setting_word())
REQUIRED(stated, "Value in the machine file.")
REQUIRED(stated_sigma, "Its uncertainty there, 1 sigma.", kNotNegative)
REQUIRED(calibrated, "Calibrated value.")
REQUIRED(sigma, "Uncertainty of the calibrated value, 1 sigma.", kNotNegative)
REQUIRED(off, "True if it differs by more than its uncertainty allows.")
END_RECORD;

}  // namespace chaintrue::grid::files
