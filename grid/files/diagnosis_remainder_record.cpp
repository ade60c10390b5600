// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::BudgetLine;
using diagnosis::CauseGivenLaw;
using diagnosis::Coordinate;
using diagnosis::Enters;
using diagnosis::ErrorBudget;
using diagnosis::Law;
using diagnosis::LawHeldOut;
using diagnosis::LawResidual;
using diagnosis::LawShape;
using diagnosis::ParameterEstimate;
using diagnosis::Unexplained;

auto budget_line_record() {
  return Record<BudgetLine>("a part of the error")
      .required("what", "The part.", &BudgetLine::what, by_name_to(BudgetLine::What::inseparable))
      .optional("cause", "The cause.", &BudgetLine::cause, cause_id_record())
      .required(
          "mean_square_mm2", "Mean square at the tool.", &BudgetLine::mean_square_mm2, kAnyNumber)
      .required("share", "Share of the total mean square.", &BudgetLine::share, kAnyNumber)
      .optional("without_mm",
                "Rms error of the tool as delivered if only this part is removed.",
                &BudgetLine::without_mm,
                kNotNegative)
      .optional("part_of_100_mm",
                "Its effect on a part of 100 mm in the worst corner.",
                &BudgetLine::part_mm,
                kNotNegative)
      .required("changes_with",
                "What it depends on.",
                &BudgetLine::changes_with,
                by_name_to(BudgetLine::ChangesWith::direction));
}

/// A value with its sigma under its parameter's name.
auto named_estimate_record() {
  return Record<ParameterEstimate>("a size with its sigma")
      .required("parameter", "Name of the parameter.", &ParameterEstimate::parameter)
      .required("value", "Its value.", &ParameterEstimate::value, kAnyNumber)
      .required("sigma", "Its uncertainty, 1 sigma.", &ParameterEstimate::sigma, kNotNegative);
}

auto law_point_record() {
  return Record<LawResidual>("a point next to a law's curve")
      .required("index", "Number of the point, from 0.", &LawResidual::index)
      .required(
          "at", "Value of the law's variable: mm, rad, N or visits.", &LawResidual::at, kAnyNumber)
      .required("residual_mm",
                "Partial residual: the law's value plus what remains unexplained in the same "
                "direction.",
                &LawResidual::residual_mm,
                kAnyNumber)
      .optional("left_x_mm",
                "Remaining shift of the tool along x after removing law, settings and causes, "
                "but not a smooth pattern. Absent for belts, which do not determine where the "
                "tool should have been.",
                &LawResidual::left_x_mm,
                kAnyNumber)
      .optional(
          "left_y_mm", "Remaining shift of the tool along y.", &LawResidual::left_y_mm, kAnyNumber);
}

auto law_errors_record() {
  return Record<LawHeldOut::Errors>("readings that were left out")
      .required("without_mm",
                "Rms without the law: of the tool for chains, of distances, of one belt.",
                &LawHeldOut::Errors::without_mm,
                kNotNegative)
      .required("with_mm", "Rms with the law.", &LawHeldOut::Errors::with_mm, kNotNegative);
}

auto law_held_out_record() {
  return Record<LawHeldOut>("how well a law predicts what was left out")
      .required("inside",
                "Every fourth place left out, four times.",
                &LawHeldOut::inside,
                law_errors_record())
      .required("outside",
                "The quarter of the bed on one side of a line left out, for sixteen lines.",
                &LawHeldOut::outside,
                law_errors_record());
}

auto law_record() {
  return Record<Law>("a law")
      .required("of",
                "Its variable: a coordinate of the sheet, the position along direction_deg, "
                "the distance inwards from the border, the length, angle or tension of a "
                "chain, the number of the visit; for four belts, a coordinate of the anchors' "
                "frame, the length of a belt or its angle against the horizontal.",
                &Law::of,
                by_name_to(Coordinate::angle_br))
      .required("shape",
                "With the variable v: linear: size (v - middle) / span, square: size ((v - "
                "place) / half the span)^2, step: size from place on, kink: size max(0, "
                "towards (v - place)) / span, exponential: size exp(-distance from the end / "
                "scale), wave: size sin(w + phase) with w = 2 pi (v - middle) / period, "
                "harmonics: size sin(w + phase) + second size sin(2 w + second phase).",
                &Law::shape,
                by_name_to(LawShape::harmonics))
      .required("enters",
                "Where it enters: a chain, both equally, the tool along x or y, the tool along the "
                "law's own direction, the tool outwards over every border, one of four belts.",
                &Law::enters,
                by_name<Enters>({Enters::left,
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
      .required("probability",
                "Probability of this variable and place of entry, for any shape.",
                &Law::probability,
                kShare)
      .required("shape_probability",
                "Probability of the shape, given these.",
                &Law::shape_probability,
                kShare)
      .optional("direction_deg",
                "Direction of an oblique law, from x towards y.",
                &Law::direction_deg,
                {"deg", -360.0, 360.0})
      .optional("towards",
                "For a kink: 1 if it acts beyond its place, -1 below; for an exponential: 1 if "
                "it is largest at the upper end of the range, -1 at the lower.",
                &Law::towards,
                integer(-1, 1))
      .required("from",
                "Smallest value of the variable among the readings: mm, rad, N or visits.",
                &Law::from,
                kAnyNumber)
      .required("to", "Largest value of the variable.", &Law::to, kAnyNumber)
      .required("rms_mm",
                "Rms at the tool, after the settings have absorbed their share.",
                &Law::rms_mm,
                kNotNegative)
      .required("share",
                "Share of the mean square that the settings do not explain.",
                &Law::share,
                kShare)
      .required("parameters",
                "Its size, and its place, scale, period and phase, with sigmas; units are at "
                "the ends of the names.",
                &Law::parameters,
                list(named_estimate_record(), 1))
      .sparse("points",
              "Points that were not rejected, for the picture of its curve.",
              &Law::points,
              law_point_record())
      .optional(
          "held_out",
          "Prediction errors for left-out readings, without the law (settings, causes and the "
          "best smooth pattern) and with it; absent if the bed has no parts to leave out.",
          &Law::held_out,
          law_held_out_record())
      .check([](const Cursor& at, Law& law) {
        if (at.child("from").clean() && at.child("to").clean() && !(law.from < law.to))
          at.child("to").expect("more than from");
        if (!at.child("shape").clean() || !at.child("parameters").clean()) return;
        const std::size_t count = diagnosis::parameter_count(law.shape);
        if (law.parameters.size() != count)
          at.child("parameters").expect(fmt::format("{} of a law of this shape", count));
      });
}

auto cause_given_law_record() {
  return Record<CauseGivenLaw>("a cause given a law")
      .required("cause", "The effect, and its side.", &CauseGivenLaw::cause, cause_id_record())
      .required("probability",
                "Probability after the law is removed.",
                &CauseGivenLaw::probability,
                kShare)
      .required("without_law",
                "Probability of the same cause without the law.",
                &CauseGivenLaw::without_law,
                kShare)
      .sparse("same_as",
              "Causes that readings of this kind cannot distinguish from it.",
              &CauseGivenLaw::same_as,
              cause_id_record())
      .sparse("parameters",
              "Its parameters given the law, with sigmas; absent if it is not named then.",
              &CauseGivenLaw::parameters,
              list(named_estimate_record(), 1));
}

}  // namespace

Record<Unexplained> unexplained_record() {
  Record<Unexplained> left("what remains besides the causes");
  left.required("probability", "Probability that it exists.", &Unexplained::probability, kShare)
      .required("delta", "Signal-to-noise ratio.", &Unexplained::signal_to_noise, kNotNegative)
      .required("rms_mm", "Rms size.", &Unexplained::rms_mm, kNotNegative)
      .required("share", "Share of the whole.", &Unexplained::share, kShare);
  left.nullable(
      "follows",
      "What it depends on: an angle, a length, a tension, the order, x, y; null: none of them.",
      &Unexplained::follows);
  left.required(
          "length_mm", "Correlation length over the bed.", &Unexplained::length_mm, kNotNegative)
      .required("enters", "Where it enters.", &Unexplained::enters, by_name_to(Enters::mixed))
      .sparse("laws",
              "Functions that it may be, most probable first; absent if no law is more likely "
              "than none.",
              &Unexplained::laws,
              law_record())
      .sparse("causes_given_law",
              "Causes that are named only after a claimed law is removed from the readings, and "
              "causes that are no longer named then.",
              &Unexplained::causes_given_law,
              cause_given_law_record());
  return left;
}

Record<ErrorBudget> error_budget_record() {
  return Record<ErrorBudget>("what the error is made of")
      .required("as_delivered_mm",
                "Rms error of the tool as delivered, at the measured "
                "points; tool_today is over the measured part.",
                &ErrorBudget::uncalibrated_mm,
                kNotNegative)
      .required("parts", "Parts of the mean square.", &ErrorBudget::lines, budget_line_record());
}

}  // namespace chaintrue::grid::files
