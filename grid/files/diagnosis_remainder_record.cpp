// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include "grid/files/diagnosis_record.hpp"
#include "grid/files/record_values.hpp"

namespace chaintrue::grid::files {
namespace {

using diagnosis::BudgetLine;
using diagnosis::Enters;

RECORD_OF(BudgetLine, "a part of the error")
REQUIRED(what, "The part.", by_name_to(BudgetLine::What::inseparable))
OPTIONAL(cause, "The cause.")
REQUIRED(mean_square_mm2, "Mean square at the tool.")
REQUIRED(share, "Share of the total mean square.")
OPTIONAL(without_mm, "Rms error of the tool as delivered if only this part is removed.",
         kNotNegative)
NAMED(optional, "part_of_100_mm", part_mm, "Its effect on a part of 100 mm in the worst corner.",
      kNotNegative)
REQUIRED(changes_with, "What it depends on.", by_name_to(BudgetLine::ChangesWith::direction))
END_RECORD;

/// A value with its sigma under its parameter's name.
auto named_estimate_record() {
  RECORD(ParameterEstimate, "a size with its sigma")
  REQUIRED(parameter, "Name of the parameter.")
  REQUIRED(value, "Its value.")
  REQUIRED(sigma, "Its uncertainty, 1 sigma.", kNotNegative);
}

RECORD_OF(diagnosis::LawResidual, "a point next to a law's curve")
REQUIRED(index, "Number of the point, from 0.")
REQUIRED(at, "Value of the law's variable: mm, rad, N or visits.")
REQUIRED(residual_mm,
         "Partial residual: the law's value plus what remains unexplained in the same "
         "direction.")
OPTIONAL(left_x_mm,
         "Remaining shift of the tool along x after removing law, settings and causes, "
         "but not a smooth pattern. Absent for belts, which do not determine where the "
         "tool should have been.")
OPTIONAL(left_y_mm, "Remaining shift of the tool along y.")
END_RECORD;

RECORD_OF(diagnosis::LawHeldOut::Errors, "readings that were left out")
REQUIRED(without_mm, "Rms without the law: of the tool for chains, of distances, of one belt.",
         kNotNegative)
REQUIRED(with_mm, "Rms with the law.", kNotNegative)
END_RECORD;

RECORD_OF(diagnosis::LawHeldOut, "how well a law predicts what was left out")
REQUIRED(inside, "Every fourth place left out, four times.")
REQUIRED(outside, "The quarter of the bed on one side of a line left out, for sixteen lines.")
END_RECORD;

RECORD_OF(diagnosis::Law, "a law")
REQUIRED(of,
         "Its variable: a coordinate of the sheet, the position along direction_deg, "
         "the distance inwards from the border, the length, angle or tension of a "
         "chain, the number of the visit; for four belts, a coordinate of the anchors' "
         "frame, the length of a belt or its angle against the horizontal.",
         by_name_to(diagnosis::Coordinate::angle_br))
REQUIRED(shape,
         "With the variable v: linear: size (v - middle) / span, square: size ((v - "
         "place) / half the span)^2, step: size from place on, kink: size max(0, "
         "towards (v - place)) / span, exponential: size exp(-distance from the end / "
         "scale), wave: size sin(w + phase) with w = 2 pi (v - middle) / period, "
         "harmonics: size sin(w + phase) + second size sin(2 w + second phase).",
         by_name_to(diagnosis::LawShape::harmonics))
REQUIRED(enters,
         "Where it enters: a chain, both equally, the tool along x or y, the tool along the "
         "law's own direction, the tool outwards over every border, one of four belts.",
         by_name<Enters>({Enters::left, Enters::right, Enters::equal, Enters::x, Enters::y,
                          Enters::along, Enters::outwards, Enters::tl, Enters::tr, Enters::bl,
                          Enters::br}))
REQUIRED(probability, "Probability of this variable and place of entry, for any shape.", kShare)
REQUIRED(shape_probability, "Probability of the shape, given these.", kShare)
OPTIONAL(direction_deg, "Direction of an oblique law, from x towards y.", {"deg", -360.0, 360.0})
OPTIONAL(towards,
         "For a kink: 1 if it acts beyond its place, -1 below; for an exponential: 1 if "
         "it is largest at the upper end of the range, -1 at the lower.",
         integer(-1, 1))
REQUIRED(from, "Smallest value of the variable among the readings: mm, rad, N or visits.")
REQUIRED(to, "Largest value of the variable.")
REQUIRED(rms_mm, "Rms at the tool, after the settings have absorbed their share.", kNotNegative)
REQUIRED(share, "Share of the mean square that the settings do not explain.", kShare)
REQUIRED(parameters,
         "Its size, and its place, scale, period and phase, with sigmas; units are at "
         "the ends of the names.",
         list(named_estimate_record(), 1))
SPARSE(points, "Points that were not rejected, for the picture of its curve.")
OPTIONAL(held_out,
         "Prediction errors for left-out readings, without the law (settings, causes and the "
         "best smooth pattern) and with it; absent if the bed has no parts to leave out.")
    .check([](const Cursor& at, diagnosis::Law& law) {
      if (at.child("from").clean() && at.child("to").clean() && !(law.from < law.to))
        at.child("to").expect("more than from");
      if (!at.child("shape").clean() || !at.child("parameters").clean()) return;
      const std::size_t count = diagnosis::parameter_names(law.shape, law.of).size();
      if (law.parameters.size() != count)
        at.child("parameters").expect(fmt::format("{} of a law of this shape", count));
    }) END_RECORD;

RECORD_OF(diagnosis::CauseGivenLaw, "a cause given a law")
REQUIRED(cause, "The effect, and its side.")
REQUIRED(probability, "Probability after the law is removed.", kShare)
REQUIRED(without_law, "Probability of the same cause without the law.", kShare)
SPARSE(same_as, "Causes that readings of this kind cannot distinguish from it.")
SPARSE(parameters, "Its parameters given the law, with sigmas; absent if it is not named then.",
       list(named_estimate_record(), 1))
END_RECORD;

}  // namespace

RECORD_OF(Unexplained, "what remains besides the causes")
REQUIRED(probability, "Probability that it exists.", kShare)
NAMED(required, "delta", signal_to_noise, "Signal-to-noise ratio.", kNotNegative)
REQUIRED(rms_mm, "Rms size.", kNotNegative)
REQUIRED(share, "Share of the whole.", kShare)
NULLABLE(follows,
         "What it depends on: an angle, a length, a tension, the order, x, y; null: none of them.")
REQUIRED(length_mm, "Correlation length over the bed.", kNotNegative)
REQUIRED(enters, "Where it enters.", by_name_to(Enters::mixed))
SPARSE(laws,
       "Functions that it may be, most probable first; absent if no law is more likely "
       "than none.")
SPARSE(causes_given_law,
       "Causes that are named only after a claimed law is removed from the readings, and "
       "causes that are no longer named then.")
END_RECORD;

RECORD_OF(ErrorBudget, "what the error is made of")
NAMED(required, "as_delivered_mm", uncalibrated_mm,
      "Rms error of the tool as delivered, at the measured "
      "points; tool_today is over the measured part.",
      kNotNegative)
NAMED(required, "parts", lines, "Parts of the mean square.")
END_RECORD;

}  // namespace chaintrue::grid::files
