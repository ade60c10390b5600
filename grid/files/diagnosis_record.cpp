// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/files/diagnosis_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::Bound;
using diagnosis::CalibratedSetting;
using diagnosis::Cause;
using diagnosis::CauseId;
using diagnosis::Hypothesis;
using diagnosis::LeftOver;
using diagnosis::MeasurementKind;
using diagnosis::NextMeasurement;
using diagnosis::NotTestable;
using diagnosis::ParameterEstimate;
using diagnosis::PointPicture;
using diagnosis::SameCause;
using diagnosis::Separation;
using diagnosis::Term;
using model::effects::Effect;
using model::effects::EffectSide;

constexpr Range kAny{"", -1e12, 1e12};
constexpr Range kMm{"mm", -1e6, 1e6};
constexpr Range kRad{"rad", -10.0, 10.0};
constexpr Range kNewton{"N", -1e6, 1e6};
constexpr Range kPositive{"", 0.0, 1e12};
constexpr Range kShare{"", 0.0, 1.0};

constexpr EffectSide kSides[] = {
    EffectSide::left, EffectSide::right, EffectSide::both, EffectSide::x, EffectSide::y};

Value<std::string> side_word() { return one_of({"left", "right", "both", "x", "y"}); }

Value<const Effect*> effect_word() {
  std::vector<std::pair<std::string, const Effect*>> names;
  for (const Effect* effect : model::effects::catalogue()) names.emplace_back(effect->id, effect);
  return choice<const Effect*>(std::move(names));
}

/// An empty text is null in the file.
template <class T>
void nullable_text(Record<T>& record,
                   const std::string& key,
                   std::string T::*member,
                   const Value<std::string>& value) {
  record.custom(
      key,
      false,
      value.expected,
      [member, value](const Cursor& at, T& object) {
        if (auto word = value.read(at)) object.*member = std::move(*word);
      },
      [member](const T& object) {
        return std::optional<Json>((object.*member).empty() ? Json(nullptr) : Json(object.*member));
      });
}

/// The keys of an effect and its side; `id` takes the object to its CauseId.
template <class T, class Access>
void cause_keys(Record<T>& record, const Access& id) {
  const Value<const Effect*> effect = effect_word();
  const Value<std::string> side = side_word();
  record.custom(
      "effect",
      true,
      effect.expected,
      [effect, id](const Cursor& at, T& object) {
        if (const auto found = effect.read(at)) id(object).effect = *found;
      },
      [id](const T& object) { return std::optional<Json>(std::string(id(object).effect->id)); });
  record.custom(
      "side",
      false,
      side.expected,
      [side, id](const Cursor& at, T& object) {
        const auto word = side.read(at);
        for (const EffectSide known : kSides) {
          if (word == name(known)) id(object).side = known;
        }
      },
      [id](const T& object) {
        const std::string word(name(id(object).side));
        return std::optional<Json>(word.empty() ? Json(nullptr) : Json(word));
      });
  record.check([id](const Cursor& at, T& object) {
    if (!at.child("effect").clean() || !at.child("side").clean()) return;
    const CauseId& found = id(object);
    if (found.effect == nullptr) return;
    const auto& sides = found.effect->sides;
    if (std::find(sides.begin(), sides.end(), found.side) == sides.end()) {
      at.child("side").expect(fmt::format("a side on which {} acts", found.effect->id));
    }
  });
}

constexpr auto kCause = [](auto& object) -> auto& { return object.cause; };

const Record<CauseId>& cause_id_record() {
  static const auto record = [] {
    Record<CauseId> id("an effect with its side");
    cause_keys(
        id, [](auto& object) -> auto& { return object; });
    return id;
  }();
  return record;
}

const Record<ParameterEstimate>& estimate_record() {
  static const auto record = Record<ParameterEstimate>("a value with its sigma")
                                 .required("value", &ParameterEstimate::value, number(kAny))
                                 .required("sigma", &ParameterEstimate::sigma, number(kPositive));
  return record;
}

/// An object with one key a parameter, in the order of the effect's parameters.
template <class T>
void parameter_keys(Record<T>& record) {
  record.custom(
      "parameters",
      true,
      "an object, each value a value with its sigma",
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
        return std::optional<Json>(std::move(json));
      });
  record.check([](const Cursor& at, T& object) {
    if (object.cause.effect == nullptr || !at.child("parameters").clean()) return;
    std::vector<std::string> names;
    for (const auto& parameter : object.cause.effect->parameters)
      names.emplace_back(parameter.name);
    for (const ParameterEstimate& estimate : object.parameters) {
      if (std::find(names.begin(), names.end(), estimate.parameter) == names.end()) {
        at.problems().add(
            at.child("parameters").pointer() + "/" + pointer_token(estimate.parameter),
            estimate.parameter,
            fmt::format("a parameter of {}: {}", object.cause.effect->id, joined(names)));
      }
    }
  });
}

const Record<SameCause>& same_cause_record() {
  static const auto record = [] {
    Record<SameCause> same("a cause of the same class");
    cause_keys(same, kCause);
    parameter_keys(same);
    return same;
  }();
  return record;
}

/// The effect that these data tell from a cause least.
struct Rival {
  CauseId cause;
  double rho = 0.0;
};

const Record<Rival>& rival_record() {
  static const auto record = [] {
    Record<Rival> rival("a rival");
    cause_keys(rival, kCause);
    rival.required("rho", &Rival::rho, number(kShare));
    return rival;
  }();
  return record;
}

/// Two numbers, as [first, second].
template <class T>
void pair_key(Record<T>& record,
              const std::string& key,
              const Range& range,
              const std::function<Eigen::Vector2d(const T&)>& get,
              const std::function<void(T&, const Eigen::Vector2d&)>& set) {
  const Value<std::vector<double>> value = list(number(range), 2);
  const std::string expected =
      fmt::format("a pair of numbers{}{}", range.unit.empty() ? "" : " in ", range.unit);
  record.custom(
      key,
      true,
      expected,
      [value, set, expected](const Cursor& at, T& object) {
        const auto read = value.read(at);
        if (read && read->size() == 2) {
          set(object, Eigen::Vector2d((*read)[0], (*read)[1]));
        } else if (read && read->size() > 2) {
          at.expect(expected);
        }
      },
      [get](const T& object) {
        const Eigen::Vector2d pair = get(object);
        return std::optional<Json>(Json::array({pair[0] + 0.0, pair[1] + 0.0}));
      });
}

void vector_key(Record<PointPicture>& record,
                const std::string& key,
                Eigen::Vector2d PointPicture::*member) {
  pair_key<PointPicture>(
      record,
      key,
      kMm,
      [member](const PointPicture& point) { return point.*member; },
      [member](PointPicture& point, const Eigen::Vector2d& pair) { point.*member = pair; });
}

/// A chain's number each, as [left, right].
void chains_key(Record<PointPicture>& record,
                const std::string& key,
                const Range& range,
                double PointPicture::*left,
                double PointPicture::*right) {
  pair_key<PointPicture>(
      record,
      key,
      range,
      [left, right](const PointPicture& point) {
        return Eigen::Vector2d(point.*left, point.*right);
      },
      [left, right](PointPicture& point, const Eigen::Vector2d& pair) {
        point.*left = pair[0];
        point.*right = pair[1];
      });
}

Value<std::size_t> index_value() {
  constexpr int kMostPoints = 1000000;
  const Value<int> whole = integer(0, kMostPoints);
  return {[whole](const Cursor& at) -> std::optional<std::size_t> {
            const auto value = whole.read(at);
            return value ? std::optional(static_cast<std::size_t>(*value)) : std::nullopt;
          },
          [](const std::size_t& value) { return Json(value); },
          whole.expected};
}

template <class T>
void place_keys(Record<T>& record,
                const std::function<model::BedPoint&(T&)>& place,
                const std::function<const model::BedPoint&(const T&)>& const_place) {
  const auto coordinate = [&](const char* key, double model::BedPoint::*member) {
    record.custom(
        key,
        true,
        "a number in mm",
        [place, member](const Cursor& at, T& object) {
          if (const auto value = at.number(kMm)) place(object).*member = *value;
        },
        [const_place, member](const T& object) {
          return std::optional<Json>(const_place(object).*member);
        });
  };
  coordinate("x_mm", &model::BedPoint::x_mm);
  coordinate("y_mm", &model::BedPoint::y_mm);
}

Value<model::Setting> setting_word() {
  std::vector<std::pair<std::string, model::Setting>> names;
  for (auto setting : model::kMachineSettings) names.emplace_back(model::name(setting), setting);
  for (auto setting : model::kSheetSettings) names.emplace_back(model::name(setting), setting);
  return choice<model::Setting>(std::move(names));
}

}  // namespace

const Record<Cause>& cause_record() {
  static const auto record = [] {
    Record<Cause> cause("a cause");
    cause_keys(cause, kCause);
    cause.required("probability", &Cause::probability, number(kShare))
        .required("delta", &Cause::delta, number(kPositive))
        .required("share_left", &Cause::share_left, number(kShare))
        .required("same_as", &Cause::same_as, list(object(same_cause_record())));
    parameter_keys(cause);
    cause.custom(
        "rival",
        false,
        rival_record().expected(),
        [](const Cursor& at, Cause& object) {
          const auto rival = rival_record().read(at);
          if (!rival) return;
          object.rival = rival->cause;
          object.rival_rho = rival->rho;
        },
        [](const Cause& object) {
          return std::optional<Json>(object.rival
                                         ? rival_record().write({*object.rival, object.rival_rho})
                                         : Json(nullptr));
        });
    cause.required("order_assumed", &Cause::order_assumed, boolean());
    return cause;
  }();
  return record;
}

const Record<Hypothesis>& hypothesis_record() {
  static const auto record = [] {
    Record<Hypothesis> hypothesis("a hypothesis");
    // Two effects at once stand as "first + second", with their sides in the same way.
    hypothesis.required("effect", &Hypothesis::effect, text());
    nullable_text(hypothesis, "side", &Hypothesis::side, text());
    hypothesis.required("probability", &Hypothesis::probability, number(kShare));
    return hypothesis;
  }();
  return record;
}

const Record<LeftOver>& left_over_record() {
  static const auto record = [] {
    Record<LeftOver> left("what is left over");
    left.required("delta", &LeftOver::delta, number(kPositive));
    nullable_text(left, "follows", &LeftOver::follows, text());
    left.required("share", &LeftOver::share, number(kShare))
        .required("p_value", &LeftOver::p_value, number(kShare));
    return left;
  }();
  return record;
}

const Record<NotTestable>& not_testable_record() {
  static const auto record = [] {
    Record<NotTestable> not_testable("an effect that could not be tested");
    cause_keys(not_testable, kCause);
    not_testable.required("reason", &NotTestable::reason, text());
    return not_testable;
  }();
  return record;
}

const Record<Bound>& bound_record() {
  static const auto record = [] {
    Record<Bound> bound("a bound");
    cause_keys(bound, kCause);
    bound.required("parameter", &Bound::parameter, text())
        .required("upper_95", &Bound::upper_95, number(kPositive));
    return bound;
  }();
  return record;
}

const Record<CalibratedSetting>& calibrated_setting_record() {
  static const auto record =
      Record<CalibratedSetting>("a setting")
          .required("setting", &CalibratedSetting::setting, setting_word())
          .required("stated", &CalibratedSetting::stated, number(kAny))
          .required("stated_sigma", &CalibratedSetting::stated_sigma, number(kPositive))
          .required("calibrated", &CalibratedSetting::calibrated, number(kAny))
          .required("sigma", &CalibratedSetting::sigma, number(kPositive))
          .required("off", &CalibratedSetting::off, boolean());
  return record;
}

const Record<NextMeasurement>& next_measurement_record() {
  static const auto record = [] {
    Record<NextMeasurement> next("a next measurement");
    next.required("kind",
                  &NextMeasurement::kind,
                  choice<MeasurementKind>({{"point", MeasurementKind::point},
                                           {"revisit", MeasurementKind::revisit},
                                           {"reading", MeasurementKind::reading}}));
    next.required("what", &NextMeasurement::what, text());
    nullable_text(next, "side", &NextMeasurement::side, side_word());
    const auto coordinate = [&next](const char* key, double model::BedPoint::*member) {
      next.custom(
          key,
          false,
          "a number in mm",
          [member](const Cursor& at, NextMeasurement& object) {
            const auto value = at.number(kMm);
            if (!value) return;
            if (!object.mark) object.mark.emplace();
            (*object.mark).*member = *value;
          },
          [member](const NextMeasurement& object) {
            return std::optional<Json>(object.mark ? Json((*object.mark).*member) : Json(nullptr));
          });
    };
    coordinate("x_mm", &model::BedPoint::x_mm);
    coordinate("y_mm", &model::BedPoint::y_mm);
    next.required("sigma", &NextMeasurement::sigma, number(kPositive))
        .required("raises_probability_to", &NextMeasurement::raises_probability_to, number(kShare))
        .check([](const Cursor& at, NextMeasurement& object) {
          const bool is_place = object.kind != MeasurementKind::reading;
          for (const char* key : {"x_mm", "y_mm"}) {
            const Cursor value = at.child(key);
            if (is_place && at.clean() && value.json().is_null()) value.missing("a number in mm");
          }
        });
    return next;
  }();
  return record;
}

const Record<PointPicture>& point_picture_record() {
  static const auto record = [] {
    Record<PointPicture> point("a point");
    point.required("index", &PointPicture::index, index_value());
    place_keys<PointPicture>(
        point,
        [](PointPicture& object) -> model::BedPoint& { return object.mark; },
        [](const PointPicture& object) -> const model::BedPoint& { return object.mark; });
    constexpr int kMostVisits = 1000000000;
    point.optional("order", &PointPicture::order, integer(-kMostVisits, kMostVisits))
        .required("bad", &PointPicture::bad, boolean());
    vector_key(point, "before_mm", &PointPicture::before_mm);
    vector_key(point, "after_mm", &PointPicture::after_mm);
    vector_key(point, "noise_sigma_mm", &PointPicture::noise_sigma_mm);
    vector_key(point, "chain_before_mm", &PointPicture::chain_before_mm);
    vector_key(point, "chain_after_mm", &PointPicture::chain_after_mm);
    vector_key(point, "best_mm", &PointPicture::best_mm);
    vector_key(point, "rival_mm", &PointPicture::rival_mm);
    pair_key<PointPicture>(
        point,
        "lengths_mm",
        kMm,
        [](const PointPicture& object) {
          return Eigen::Vector2d(object.lengths.left_mm, object.lengths.right_mm);
        },
        [](PointPicture& object, const Eigen::Vector2d& pair) {
          object.lengths = {pair[0], pair[1]};
        });
    chains_key(
        point, "angles_rad", kRad, &PointPicture::angle_left_rad, &PointPicture::angle_right_rad);
    chains_key(point,
               "tensions_n",
               kNewton,
               &PointPicture::tension_left_n,
               &PointPicture::tension_right_n);
    point.required("direction_left", &PointPicture::direction_left, integer(-1, 1))
        .required("direction_right", &PointPicture::direction_right, integer(-1, 1));
    return point;
  }();
  return record;
}

const Record<Term>& term_record() {
  static const auto record = [] {
    Record<Term> term("a term");
    cause_keys(term, kCause);
    term.required("parameter", &Term::parameter, text())
        .required("value", &Term::value, number(kAny))
        .required("sigma", &Term::sigma, number(kPositive))
        .required("delta", &Term::delta, number(kPositive))
        .required("share_left", &Term::share_left, number(kShare))
        .required("p_value", &Term::p_value, number(kShare))
        .required("probability", &Term::probability, number(kShare));
    return term;
  }();
  return record;
}

const Record<Separation>& separation_record() {
  static const auto record = [] {
    Record<Separation> separation("how well two effects are told apart");
    for (const auto& [key, member] :
         {std::pair("first", &Separation::first), std::pair("second", &Separation::second)}) {
      separation.required(key, member, object(cause_id_record()));
    }
    // Null: no strength is enough.
    const Value<double> needed = number(kPositive);
    separation.required("rho", &Separation::rho, number(kShare))
        .custom(
            "delta_needed",
            false,
            needed.expected,
            [needed](const Cursor& at, Separation& object) {
              if (const auto value = needed.read(at)) object.delta_needed = *value;
            },
            [needed](const Separation& object) {
              return std::optional<Json>(std::isfinite(object.delta_needed)
                                             ? needed.write(object.delta_needed)
                                             : Json(nullptr));
            })
        .check([](const Cursor& at, Separation& object) {
          if (at.child("delta_needed").json().is_null()) {
            object.delta_needed = std::numeric_limits<double>::infinity();
          }
        });
    return separation;
  }();
  return record;
}

}  // namespace chaintrue::grid::files
