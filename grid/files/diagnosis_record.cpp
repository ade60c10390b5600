// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/diagnosis_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

#include "grid/containers.hpp"
#include "grid/files/effect_record.hpp"
#include "grid/files/record_values.hpp"
#include "model/belts/belt_effects.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"
#include "model/plotter/plotter_effects.hpp"

namespace chaintrue::grid::files {

namespace {

using diagnosis::Bound;
using diagnosis::CalibratedSetting;
using diagnosis::Cause;
using diagnosis::CauseId;
using diagnosis::DeclaredAnswer;
using diagnosis::Hypothesis;
using diagnosis::LeftOver;
using diagnosis::NotTestable;
using diagnosis::ParameterEstimate;
using diagnosis::SameCause;
using model::effects::Effect;
using model::effects::EffectSide;

/// An effect of chains, or of belts or cords if chains have none of that name.
Value<const Effect*> effect_word() {
  std::vector<std::pair<std::string, const Effect*>> names;
  for (const Effect* effect : model::effects::catalogue()) names.emplace_back(effect->id, effect);
  for (const auto table : {model::belts::belt_effects(), model::plotter::plotter_effects()}) {
    for (const Effect* effect : table)
      if (model::effects::find_effect(effect->id) == nullptr)
        names.emplace_back(effect->id, effect);
  }
  return choice_of<const Effect*>(std::move(names));
}

bool acts_at(const Effect& effect, EffectSide side) { return contains(effect.sides, side); }

/// The keys of an effect and its side; `id` maps the object to its CauseId.
template <class T, class Access>
void cause_keys(Record<T>& record, const Access& id) {
  Value<const Effect*> effect = effect_word();
  // Effects that the extended machine declares have their own names.
  effect.expected.schema = [names = effect.expected.schema]() -> Json {
    return {{"type", "string"}, {"examples", names()["enum"]}};
  };
  const Value<EffectSide> side = by_name_to(EffectSide::all, EffectSide::left);
  record.custom(
      "effect",
      "The effect's name, as chaintrue effects lists them.",
      true,
      effect.expected,
      [effect, id](const Cursor& at, T& object) {
        const Effect* declared = at.json().is_string()
                                     ? declared_in_document(at, at.json().get<std::string>())
                                     : nullptr;
        if (declared != nullptr) {
          id(object).effect = declared;
        } else if (const auto found = effect.read(at)) {
          id(object).effect = *found;
        }
      },
      [id](const T& object) { return id(object).effect->id; });
  record.custom(
      "side",
      "Where it acts; null for effects without a side.",
      false,
      side.expected,
      [side, id](const Cursor& at, T& object) {
        if (const auto own = side.read(at)) id(object).side = *own;
      },
      [side, id](const T& object) {
        const EffectSide own = id(object).side;
        return own == EffectSide::none ? Json(nullptr) : side.write(own);
      });
  record.check([id](const Cursor& at, T& object) {
    if (!at.child("effect").clean() || !at.child("side").clean()) return;
    CauseId& found = id(object);
    if (found.effect == nullptr || acts_at(*found.effect, found.side)) return;
    // Both chains and belts have drift and skips: the side decides which.
    const Effect* of_belts =
        model::effects::find_effect(model::belts::belt_effects(), found.effect->id);
    if (of_belts != nullptr && acts_at(*of_belts, found.side)) {
      found.effect = of_belts;
    } else {
      at.child("side").expect(fmt::format("a side on which {} acts", found.effect->id));
    }
  });
}

constexpr auto kCause = [](auto& object) -> auto& { return object.cause; };

}  // namespace

Record<CauseId> cause_id_record() {
  Record<CauseId> id("an effect with its side");
  cause_keys(
      id, [](auto& object) -> auto& { return object; });
  return id;
}

namespace {

auto estimate_record() {
  return Record<ParameterEstimate>("a value with its sigma")
      .required("value", "The value.", &ParameterEstimate::value, kAnyNumber)
      .required("sigma", "Its uncertainty, 1 sigma.", &ParameterEstimate::sigma, kNotNegative);
}

/// An object with one key for each parameter, in the order of the effect's parameters.
template <class T>
void parameter_keys(Record<T>& record) {
  record.custom(
      "parameters",
      "Its size and other parameters, each with its sigma.",
      true,
      {"an object, each value a value with its sigma",
       [] { return dictionary_schema(estimate_record().schema()); }},
      [](const Cursor& at, T& object) {
        if (!at.json().is_object())
          return at.expect("an object, each value a value with its sigma");
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
    std::vector<std::string> names;
    for (const auto& parameter : object.cause.effect->parameters)
      names.emplace_back(parameter.name);
    for (const ParameterEstimate& estimate : object.parameters) {
      if (!contains(names, estimate.parameter)) {
        at.child("parameters")
            .child(estimate.parameter)
            .report(estimate.parameter,
                    ProblemKind::unknown_word,
                    fmt::format("a parameter of {}: {}", object.cause.effect->id, joined(names)));
      }
    }
  });
}

auto same_cause_record() {
  Record<SameCause> same("a cause of the same class");
  cause_keys(same, kCause);
  parameter_keys(same);
  return same;
}

/// The effect that is hardest to distinguish from a cause with these data.
struct Rival {
  CauseId cause;
  double collinearity = 0.0;
};

auto rival_record() {
  Record<Rival> rival("a rival");
  cause_keys(rival, kCause);
  rival.required("rho",
                 "Collinearity of its signature with the cause's: 0 different, 1 the same.",
                 &Rival::collinearity,
                 kShare);
  return rival;
}

}  // namespace

Record<Cause> cause_record() {
  Record<Cause> cause("a cause");
  cause_keys(cause, kCause);
  cause.required("probability", "Its probability.", &Cause::probability, kShare)
      .required("delta", "Signal-to-noise ratio.", &Cause::signal_to_noise, kNotNegative)
      .required("share_left",
                "Share of its signature that the settings do not absorb.",
                &Cause::share_left,
                kShare)
      .required("same_as",
                "Causes that such data cannot distinguish from it, with their sizes.",
                &Cause::same_as,
                same_cause_record());
  parameter_keys(cause);
  cause.custom(
      "rival",
      "The effect that is hardest to distinguish from it in these data.",
      false,
      rival_record().expected(),
      [](const Cursor& at, Cause& object) {
        const auto rival = rival_record().read(at);
        if (!rival) return;
        object.rival = rival->cause;
        object.rival_collinearity = rival->collinearity;
      },
      [](const Cause& object) {
        return object.rival ? rival_record().write({*object.rival, object.rival_collinearity})
                            : Json(nullptr);
      });
  cause.required("order_assumed",
                 "It needs the order of the visits, which was not recorded.",
                 &Cause::order_assumed);
  return cause;
}

Record<Hypothesis> hypothesis_record() {
  Record<Hypothesis> hypothesis("a hypothesis");
  // Two effects at once are written as "first + second", and their sides likewise.
  hypothesis.required("effect",
                      "An effect's name, or nothing, unknown, noise, bad_points; two together "
                      "are written first + second.",
                      &Hypothesis::effect);
  hypothesis.nullable("side", "Its side, or both sides equally.", &Hypothesis::side);
  hypothesis.required("probability", "Its probability.", &Hypothesis::probability, kShare);
  return hypothesis;
}

Record<LeftOver> left_over_record() {
  Record<LeftOver> left("what remains");
  left.required("delta", "Signal-to-noise ratio.", &LeftOver::signal_to_noise, kNotNegative);
  left.nullable(
      "follows",
      "What it depends on: an angle, a length, a tension, the order, x, y; null: none of them.",
      &LeftOver::follows);
  left.required("share", "Share of the whole.", &LeftOver::share, kShare)
      .required("p_value", "How often noise alone gives as much.", &LeftOver::p_value, kShare);
  return left;
}

Record<NotTestable> not_testable_record() {
  Record<NotTestable> not_testable("an effect that could not be tested");
  cause_keys(not_testable, kCause);
  not_testable.required("reason", "The reason.", &NotTestable::reason);
  return not_testable;
}

Record<Bound> bound_record() {
  Record<Bound> bound("a bound");
  cause_keys(bound, kCause);
  bound.required("parameter", "The parameter of the effect.", &Bound::parameter)
      .required("upper_95", "Upper limit with 95 % probability.", &Bound::upper_95, kNotNegative);
  return bound;
}

Record<DeclaredAnswer> declared_answer_record() {
  Record<DeclaredAnswer> answer("an answer");
  cause_keys(answer, kCause);
  answer
      .required(
          "says",
          "confirmed: named at 90 % or more; denied: at most 10 %, although it would have shown "
          "at its declared size; open: neither; not_testable: these readings cannot show it.",
          &DeclaredAnswer::says,
          by_name_to(DeclaredAnswer::Says::not_testable))
      .required("probability", "Probability that it acts.", &DeclaredAnswer::probability, kShare);
  return answer;
}

Record<CalibratedSetting> calibrated_setting_record() {
  return Record<CalibratedSetting>("a setting")
      .required("setting", "Name of the setting.", &CalibratedSetting::setting, setting_word())
      .required("stated", "Value in the machine file.", &CalibratedSetting::stated, kAnyNumber)
      .required("stated_sigma",
                "Its uncertainty there, 1 sigma.",
                &CalibratedSetting::stated_sigma,
                kNotNegative)
      .required("calibrated", "Calibrated value.", &CalibratedSetting::calibrated, kAnyNumber)
      .required("sigma",
                "Uncertainty of the calibrated value, 1 sigma.",
                &CalibratedSetting::sigma,
                kNotNegative)
      .required("off",
                "True if it differs by more than its uncertainty allows.",
                &CalibratedSetting::off);
}

}  // namespace chaintrue::grid::files
