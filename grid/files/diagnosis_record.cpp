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

constexpr EffectSide kSides[] = {EffectSide::left,
                                 EffectSide::right,
                                 EffectSide::both,
                                 EffectSide::x,
                                 EffectSide::y,
                                 EffectSide::tl,
                                 EffectSide::tr,
                                 EffectSide::bl,
                                 EffectSide::br,
                                 EffectSide::all};

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
  const Value<std::string> side = side_word();
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
      [id](const T& object) { return std::optional<Json>(std::string(id(object).effect->id)); });
  record.custom(
      "side",
      "Where it acts; null for effects without a side.",
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

Record<ParameterEstimate> estimate_record() {
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
        return std::optional<Json>(std::move(json));
      });
  record.check([](const Cursor& at, T& object) {
    if (object.cause.effect == nullptr || !at.child("parameters").clean()) return;
    std::vector<std::string> names;
    for (const auto& parameter : object.cause.effect->parameters)
      names.emplace_back(parameter.name);
    for (const ParameterEstimate& estimate : object.parameters) {
      if (!contains(names, estimate.parameter)) {
        at.problems().add(
            at.child("parameters").pointer() + "/" + pointer_token(estimate.parameter),
            estimate.parameter,
            fmt::format("a parameter of {}: {}", object.cause.effect->id, joined(names)),
            ProblemKind::unknown_word);
      }
    }
  });
}

Record<SameCause> same_cause_record() {
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

Record<Rival> rival_record() {
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
                list(same_cause_record()));
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
        return std::optional<Json>(
            object.rival ? rival_record().write({*object.rival, object.rival_collinearity})
                         : Json(nullptr));
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
  using Says = DeclaredAnswer::Says;
  Record<DeclaredAnswer> answer("an answer");
  cause_keys(answer, kCause);
  answer
      .required(
          "says",
          "confirmed: named at 90 % or more; denied: at most 10 %, although it would have shown "
          "at its declared size; open: neither; not_testable: these readings cannot show it.",
          &DeclaredAnswer::says,
          by_name({Says::confirmed, Says::denied, Says::open, Says::not_testable}))
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

namespace {

using diagnosis::HeldOut;
using diagnosis::HeldOutImprovement;
using diagnosis::Transfer;

constexpr int kMostFolds = 1000;

/// A modelling scheme by its key; the sheet's placement alone does not exist for every grid.
template <class T>
struct ErrorRow {
  std::string_view key;
  std::string_view meaning;
  HeldOut T::*member = nullptr;
  std::optional<HeldOut> T::*maybe = nullptr;

  [[nodiscard]] const HeldOut* of(const T& object) const {
    if (member != nullptr) return &(object.*member);
    return object.*maybe ? &*(object.*maybe) : nullptr;
  }
  [[nodiscard]] HeldOut& made_in(T& object) const {
    if (member != nullptr) return object.*member;
    if (!(object.*maybe)) (object.*maybe).emplace();
    return *(object.*maybe);
  }
};

constexpr std::string_view kAsDelivered =
    "As delivered: with the machine file's settings, for commands with the controller's. At the "
    "measured points; tool_today is over the measured part.";
constexpr std::string_view kCalibrated = "With calibrated settings.";
constexpr std::string_view kWithCauses = "With the named causes.";
constexpr std::string_view kAndSurface = "With the causes and a smooth surface.";

using Improvement = HeldOutImprovement;
constexpr std::array kImprovementRows = {
    ErrorRow<Improvement>{"as_delivered", kAsDelivered, &Improvement::uncalibrated},
    ErrorRow<Improvement>{
        "placed", "After the best placement of the sheet.", nullptr, &Improvement::placed},
    ErrorRow<Improvement>{"calibrated", kCalibrated, &Improvement::calibrated},
    ErrorRow<Improvement>{"extended", kWithCauses, &Improvement::extended},
    ErrorRow<Improvement>{"extended_and_surface", kAndSurface, &Improvement::extended_and_surface},
    ErrorRow<Improvement>{
        "surface_only", "With a smooth surface and no cause.", &Improvement::surface_only},
};
constexpr std::array kTransferRows = {
    ErrorRow<Transfer>{"as_delivered", kAsDelivered, &Transfer::uncalibrated},
    ErrorRow<Transfer>{"calibrated", kCalibrated, &Transfer::calibrated},
    ErrorRow<Transfer>{"extended", kWithCauses, &Transfer::extended},
    ErrorRow<Transfer>{"extended_and_surface", kAndSurface, &Transfer::extended_and_surface},
};

/// One figure of a row: read into the row and written from it.
struct Figure {
  Expected expected;
  std::function<void(const Cursor&, HeldOut&)> read;
  std::function<Json(const HeldOut&)> write;
};

Figure single(double HeldOut::*member) {
  const Value<double> value = number(kSigmaMm);
  return {value.expected,
          [value, member](const Cursor& at, HeldOut& row) {
            if (const auto read = value.read(at)) row.*member = *read;
          },
          [value, member](const HeldOut& row) { return value.write(row.*member); }};
}

Figure interval() {
  constexpr const char* kExpected = "a pair of numbers in mm, the lower one first";
  const Value<std::vector<double>> value = list(number(kSigmaMm), 2);
  return {{kExpected,
           [value] {
             Json schema = value.expected.schema();
             schema["maxItems"] = 2;
             return schema;
           }},
          [value](const Cursor& at, HeldOut& row) {
            const auto read = value.read(at);
            if (!read || read->size() < 2) return;
            if (read->size() > 2 || (*read)[1] < (*read)[0]) return at.expect(kExpected);
            row.low_mm = (*read)[0];
            row.high_mm = (*read)[1];
          },
          [](const HeldOut& row) {
            return Json::array({row.low_mm, row.high_mm});
          }};
}

/// An object with one figure for every row; `floor`, if given, is its last key.
template <class T, std::size_t kCount>
Record<T> figure_record(const std::array<ErrorRow<T>, kCount>& rows,
                        const Figure& figure,
                        double T::*floor = nullptr) {
  Record<T> record("an object with one number for each model");
  for (const ErrorRow<T>& row : rows) {
    record.custom(
        row.key,
        row.meaning,
        row.member != nullptr,
        figure.expected,
        [row, figure](const Cursor& at, T& object) { figure.read(at, row.made_in(object)); },
        [row, figure](const T& object) {
          const HeldOut* held = row.of(object);
          return held != nullptr ? std::optional<Json>(figure.write(*held)) : std::nullopt;
        });
  }
  if (floor != nullptr) record.required("noise_floor", "From noise alone.", floor, kSigmaMm);
  return record;
}

template <class T, std::size_t kCount>
void error_figures(Record<T>& record, const std::array<ErrorRow<T>, kCount>& rows) {
  static const auto rms = figure_record(rows, single(&HeldOut::rms_mm), &T::noise_floor_mm);
  static const auto worst = figure_record(rows, single(&HeldOut::percentile_95_mm));
  static const auto intervals = figure_record(rows, interval());
  record
      .part("position_rms_mm", "Rms error at the tool (for holes alone: of a distance).", true, rms)
      .part("position_percentile_95_mm", "95th percentile of the error.", true, worst)
      .part("position_rms_90_percent_mm", "90 % interval of the rms.", true, intervals);
}

}  // namespace

Record<HeldOutImprovement> improvement_record() {
  Record<HeldOutImprovement> improvement("the gain");
  improvement.required("scheme", "How points were left out.", &HeldOutImprovement::scheme);
  error_figures(improvement, kImprovementRows);
  improvement
      .required(
          "drop_mm2", "Reduction of the mean square.", &HeldOutImprovement::drop_mm2, kSigmaMm)
      .required("drop_share", "The same as a share.", &HeldOutImprovement::drop_share, kShare)
      .required("folds",
                "Number of times that points were left out.",
                &HeldOutImprovement::folds,
                integer(0, kMostFolds))
      .required("folds_agree",
                "Number of these in which the same was named.",
                &HeldOutImprovement::folds_agree,
                integer(0, kMostFolds))
      .check([](const Cursor& at, HeldOutImprovement& object) {
        if (at.clean() && object.folds_agree > object.folds)
          at.child("folds_agree").expect("at most as many as folds");
      });
  return improvement;
}

Record<Transfer> transfer_record() {
  Record<Transfer> transfer("another grid predicted");
  transfer.required("to", "Name of the grid.", &Transfer::to)
      .required("points", "Number of its points.", &Transfer::points, index_number());
  error_figures(transfer, kTransferRows);
  return transfer;
}

using diagnosis::PartFinding;
using diagnosis::Removal;
using diagnosis::Stability;
using diagnosis::Verdict;

Value<Verdict> verdict_word() {
  return by_name({Verdict::named,
                  Verdict::named_set,
                  Verdict::several_causes,
                  Verdict::model_discrepancy,
                  Verdict::noise_larger_than_stated,
                  Verdict::outliers,
                  Verdict::nothing_found});
}

namespace {

bool is_line(const Removal& removal) {
  return removal.what == Removal::What::column || removal.what == Removal::What::row;
}

/// Something numbered: a point, a distance or a hole.
struct Numbered {
  Removal::What what;
  const char* key;
  const char* meaning;
  const char* expected;
};
constexpr Numbered kNumbered[] = {
    {Removal::What::point, "point", "Index of the point.", "a point's index"},
    {Removal::What::distance, "distance", "Index of the distance.", "a distance's index"},
    {Removal::What::hole, "hole", "Index of the hole.", "a hole's index"}};

/// The number, for the kind that is left out. Lines have none.
void index_key(const Numbered& numbered, Record<Removal>& record) {
  static const Value<int> whole = integer(0, kMostNumbered);
  record.custom(
      numbered.key,
      numbered.meaning,
      false,
      whole.expected,
      [](const Cursor& at, Removal& object) {
        if (const auto value = whole.read(at)) object.index = static_cast<std::size_t>(*value);
      },
      [what = numbered.what](const Removal& object) {
        if (object.what == what) return std::optional<Json>(object.index);
        return what == Removal::What::point ? std::optional<Json>(nullptr) : std::nullopt;
      });
}

/// The position of a column or row.
void line_key(Record<Removal>& record) {
  record.custom(
      "at_mm",
      "x of a column, y of a row.",
      false,
      {"a number in mm", [] { return number_schema(kMillimetres); }},
      [](const Cursor& at, Removal& object) {
        if (const auto value = at.number(kMillimetres)) object.at_mm = *value;
      },
      [](const Removal& object) {
        return std::optional<Json>(is_line(object) ? Json(object.at_mm) : Json(nullptr));
      });
}

Record<Removal> removal_record() {
  Record<Removal> removal("points left out");
  removal.required("what",
                   "What was left out.",
                   &Removal::what,
                   choice<Removal::What>({{"point", Removal::What::point},
                                          {"column", Removal::What::column},
                                          {"row", Removal::What::row},
                                          {"distance", Removal::What::distance},
                                          {"hole", Removal::What::hole}}));
  for (const Numbered& numbered : kNumbered) index_key(numbered, removal);
  line_key(removal);
  removal
      .required("points", "Number of points left out with it.", &Removal::points, index_number(1))
      .required("verdict", "Verdict without it.", &Removal::verdict, verdict_word())
      .required("causes", "Causes named without it.", &Removal::causes, list(cause_id_record()))
      .required("stands", "True if the answer is the same.", &Removal::stands)
      .required("probability", "Probability of the name without it.", &Removal::probability, kShare)
      .required("support",
                "Share of the log evidence that depends on it, in natural logarithms.",
                &Removal::support,
                kAnyNumber)
      .check([](const Cursor& at, Removal& object) {
        if (!at.clean() || !at.has("what")) return;
        const char* key = "at_mm";
        const char* expected = "a number in mm";
        for (const Numbered& numbered : kNumbered) {
          if (numbered.what != object.what) continue;
          key = numbered.key;
          expected = numbered.expected;
        }
        const Cursor place = at.child(key);
        if (place.json().is_null()) place.missing(expected);
      });
  return removal;
}

}  // namespace

Record<Stability> stability_record() {
  return Record<Stability>("whether the name is stable")
      .required("probability", "Smallest probability of the name.", &Stability::probability, kShare)
      .required("removals",
                "What was left out, one at a time.",
                &Stability::removals,
                list(removal_record()));
}

namespace {

void part_keys(Record<PartFinding>& part, const char* leading, const char* named) {
  part.required("units", "Number of readings in it.", &PartFinding::units, index_number())
      .required("leading", leading, &PartFinding::likeliest, hypothesis_record())
      .required("named", named, &PartFinding::named, list(hypothesis_record()));
}

}  // namespace

Record<PartFinding> bed_part_record() {
  Record<PartFinding> part("the probabilities without a quarter of the bed");
  part.required("towards_rad",
                "Direction of the quarter from the middle of the readings; from x towards y.",
                &PartFinding::towards_rad,
                kAnyNumber);
  part_keys(part,
            "Most probable cause without it; nothing if none is more likely than not.",
            "The named causes, with their probabilities without it.");
  return part;
}

Record<PartFinding> session_record() {
  Record<PartFinding> part("the probabilities of a session by itself");
  part.required("session", "The file.", &PartFinding::session);
  part_keys(part,
            "Most probable cause for its readings alone; nothing if none is more likely than not.",
            "The named causes, with their probabilities for these readings alone.");
  return part;
}

}  // namespace chaintrue::grid::files
