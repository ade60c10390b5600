// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <array>

#include "grid/files/diagnosis_keys.hpp"
#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::BudgetLine;
using diagnosis::CauseGivenLaw;
using diagnosis::CauseId;
using diagnosis::Coordinate;
using diagnosis::Enters;
using diagnosis::ErrorBudget;
using diagnosis::Law;
using diagnosis::LawHeldOut;
using diagnosis::LawResidual;
using diagnosis::LawShape;
using diagnosis::ParameterEstimate;
using diagnosis::Unexplained;

template <class Word, std::size_t kCount>
Value<Word> words(const std::array<Word, kCount>& all) {
  std::vector<std::pair<std::string, Word>> names;
  for (const Word word : all) names.emplace_back(name(word), word);
  return choice<Word>(std::move(names));
}

const Record<BudgetLine>& budget_line_record() {
  using What = BudgetLine::What;
  using ChangesWith = BudgetLine::ChangesWith;
  static const auto record =
      Record<BudgetLine>("a part of the error")
          .required(
              "what",
              &BudgetLine::what,
              words(std::array{
                  What::settings, What::cause, What::unexplained, What::noise, What::inseparable}))
          .optional("cause", &BudgetLine::cause, object(cause_id_record()))
          .required("mean_square_mm2", &BudgetLine::mean_square_mm2, number(kAnyNumber))
          .required("share", &BudgetLine::share, number(kAnyNumber))
          .optional("without_mm", &BudgetLine::without_mm, number(kNotNegative))
          .optional("part_of_100_mm", &BudgetLine::part_mm, number(kNotNegative))
          .required("changes_with",
                    &BudgetLine::changes_with,
                    words(std::array{ChangesWith::nothing,
                                     ChangesWith::place,
                                     ChangesWith::order,
                                     ChangesWith::direction}));
  return record;
}

/// A value with its sigma under its parameter's name.
const Record<ParameterEstimate>& named_estimate_record() {
  static const auto record =
      Record<ParameterEstimate>("a size with its sigma")
          .required("parameter", &ParameterEstimate::parameter, text())
          .required("value", &ParameterEstimate::value, number(kAnyNumber))
          .required("sigma", &ParameterEstimate::sigma, number(kNotNegative));
  return record;
}

const Record<LawResidual>& law_point_record() {
  static const auto record =
      Record<LawResidual>("a point next to a law's curve")
          .required("index", &LawResidual::index, index_number())
          .required("at", &LawResidual::at, number(kAnyNumber))
          .required("residual_mm", &LawResidual::residual_mm, number(kAnyNumber))
          .optional("left_x_mm", &LawResidual::left_x_mm, number(kAnyNumber))
          .optional("left_y_mm", &LawResidual::left_y_mm, number(kAnyNumber));
  return record;
}

const Record<LawHeldOut::Errors>& law_errors_record() {
  static const auto record =
      Record<LawHeldOut::Errors>("readings that were left out")
          .required("without_mm", &LawHeldOut::Errors::without_mm, number(kNotNegative))
          .required("with_mm", &LawHeldOut::Errors::with_mm, number(kNotNegative));
  return record;
}

const Record<LawHeldOut>& law_held_out_record() {
  static const auto record = Record<LawHeldOut>("how well a law predicts what was left out")
                                 .required("inside", &LawHeldOut::inside, object(law_errors_record()))
                                 .required("outside", &LawHeldOut::outside, object(law_errors_record()));
  return record;
}

const Record<Law>& law_record() {
  static const auto record =
      Record<Law>("a law")
          .required("of",
                    &Law::of,
                    words(std::array{Coordinate::x,
                                     Coordinate::y,
                                     Coordinate::across,
                                     Coordinate::border,
                                     Coordinate::length_left,
                                     Coordinate::length_right,
                                     Coordinate::angle_left,
                                     Coordinate::angle_right,
                                     Coordinate::tension_left,
                                     Coordinate::tension_right,
                                     Coordinate::visit,
                                     Coordinate::length_tl,
                                     Coordinate::length_tr,
                                     Coordinate::length_bl,
                                     Coordinate::length_br,
                                     Coordinate::angle_tl,
                                     Coordinate::angle_tr,
                                     Coordinate::angle_bl,
                                     Coordinate::angle_br}))
          .required("shape",
                    &Law::shape,
                    words(std::array{LawShape::linear,
                                     LawShape::square,
                                     LawShape::step,
                                     LawShape::kink,
                                     LawShape::exponential,
                                     LawShape::wave,
                                     LawShape::harmonics}))
          .required("enters",
                    &Law::enters,
                    words(std::array{Enters::left,
                                     Enters::right,
                                     Enters::equal,
                                     Enters::x,
                                     Enters::y,
                                     Enters::along,
                                     Enters::outwards,
                                     Enters::tl,
                                     Enters::tr,
                                     Enters::bl,
                                     Enters::br}))
          .required("probability", &Law::probability, number(kShare))
          .required("shape_probability", &Law::shape_probability, number(kShare))
          .optional("direction_deg", &Law::direction_deg, number({"deg", -360.0, 360.0}))
          .optional("towards", &Law::towards, integer(-1, 1))
          .required("from", &Law::from, number(kAnyNumber))
          .required("to", &Law::to, number(kAnyNumber))
          .required("rms_mm", &Law::rms_mm, number(kNotNegative))
          .required("share", &Law::share, number(kShare))
          .required("parameters", &Law::parameters, list(object(named_estimate_record()), 1))
          .sparse("points", &Law::points, list(object(law_point_record())))
          .optional("held_out", &Law::held_out, object(law_held_out_record()))
          .check([](const Cursor& at, Law& law) {
            if (at.child("from").clean() && at.child("to").clean() && !(law.from < law.to))
              at.child("to").expect("more than from");
            if (!at.child("shape").clean() || !at.child("parameters").clean()) return;
            const std::size_t count = diagnosis::parameter_count(law.shape);
            if (law.parameters.size() != count)
              at.child("parameters").expect(fmt::format("{} of a law of this shape", count));
          });
  return record;
}

const Record<CauseGivenLaw>& cause_given_law_record() {
  static const auto record =
      Record<CauseGivenLaw>("a cause given a law")
          .required("cause", &CauseGivenLaw::cause, object(cause_id_record()))
          .required("probability", &CauseGivenLaw::probability, number(kShare))
          .required("without_law", &CauseGivenLaw::without_law, number(kShare))
          .sparse("same_as", &CauseGivenLaw::same_as, list(object(cause_id_record())))
          .sparse("parameters", &CauseGivenLaw::parameters, list(object(named_estimate_record()), 1));
  return record;
}

}  // namespace

const Record<Unexplained>& unexplained_record() {
  static const auto record = [] {
    Record<Unexplained> left("what remains besides the causes");
    left.required("probability", &Unexplained::probability, number(kShare))
        .required("delta", &Unexplained::signal_to_noise, number(kNotNegative))
        .required("rms_mm", &Unexplained::rms_mm, number(kNotNegative))
        .required("share", &Unexplained::share, number(kShare));
    left.nullable("follows", &Unexplained::follows, text());
    left.required("length_mm", &Unexplained::length_mm, number(kNotNegative))
        .required("enters",
                  &Unexplained::enters,
                  words(std::array{Enters::left,
                                   Enters::right,
                                   Enters::equal,
                                   Enters::opposite,
                                   Enters::x,
                                   Enters::y,
                                   Enters::mixed}))
        .sparse("laws", &Unexplained::laws, list(object(law_record())))
        .sparse("causes_given_law", &Unexplained::causes_given_law, list(object(cause_given_law_record())));
    return left;
  }();
  return record;
}

const Record<ErrorBudget>& error_budget_record() {
  static const auto record =
      Record<ErrorBudget>("what the error is made of")
          .required("as_delivered_mm", &ErrorBudget::uncalibrated_mm, number(kNotNegative))
          .required("parts", &ErrorBudget::lines, list(object(budget_line_record())));
  return record;
}

}  // namespace chaintrue::grid::files
