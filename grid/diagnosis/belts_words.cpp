// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/belts/scale_by_tape.hpp"
#include "grid/diagnosis/belts_analysis.hpp"
#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "model/belts/belt_effects.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// An end of a distance as in files: an anchor's name, a point's number, or a hole's command.
std::string end_of(const BeltEnd& end, const PointIndices& indices) {
  if (const auto* index = std::get_if<std::size_t>(&end))
    return fmt::format("{}", index_in_file(indices, *index));
  if (const auto* belt = std::get_if<Belt>(&end)) return std::string(name(*belt));
  const BedPoint at = std::get<CutHole>(end).commanded;
  return fmt::format("({:g}, {:g})", at.x_mm, at.y_mm);
}

std::string improvement_words(const BeltsFindings& found) {
  std::string text = fmt::format(" The error of one belt's reading falls from {:.2f} to {:.2f} mm",
                                 found.spread_before_mm, found.residual_sigma_mm);
  if (found.prediction && found.prediction_before) {
    text += fmt::format(
        "; that of the lower belts, predicted from the upper two at left-out places, from {:.2f} "
        "to {:.2f} mm",
        found.prediction_before->rms_mm, found.prediction->rms_mm);
  }
  return text + ".";
}

/// Causes likely enough to mention although none is named: one set.
std::string short_of_a_name(const Diagnosis& d) {
  // The prior of one cause is a sixth; a fifth means that the readings raised it.
  constexpr double kToThinkOf = 0.2;
  constexpr double kInTheSet = 0.1;
  std::vector<std::string> parts;
  double most = 0.0;
  for (const Hypothesis& own : d.hypotheses) {
    // Yielding under the pull is expected; if it is not named, the readings speak against it.
    if (own.probability < kInTheSet || own.causes.empty()) continue;
    const CauseId& cause = own.causes.front();
    if (cause.effect->expected > 0.0) continue;
    parts.push_back(fmt::format("{}, {}", sized(cause, {}), percent(own.probability)));
    most = std::max(most, own.probability);
  }
  if (most < kToThinkOf) return "";
  return parts.size() == 1
             ? fmt::format(" No cause is certain, but one is possible: {}.", parts.front())
             : fmt::format(
                   " No cause is certain, but one of {} is possible; these lengths do not "
                   "distinguish them: {}.",
                   parts.size(), joined(parts, "or"));
}

std::string sentence(const Diagnosis& d) {
  switch (d.verdict) {
    case Verdict::named:
    case Verdict::named_set:
    case Verdict::several_causes:
      return causes_in_words(d) + improvement_words(*d.belts);
    case Verdict::outliers:
      return only_outliers_in_words(d);
    case Verdict::model_discrepancy:
      if (claimed_law(d) != nullptr) {
        return claimed_law_in_words(d) +
               (d.unexplained->causes_given_law.empty() ? short_of_a_name(d) : "");
      }
      return fmt::format(
                 "The errors of the lengths, {:.2f} mm per belt, change smoothly over about {:.0f} "
                 "mm of the sheet, and no listed cause explains them.",
                 d.unexplained->rms_mm, d.unexplained->length_mm) +
             short_of_a_name(d);
    default:
      return fmt::format(
                 "Nothing is wrong apart from the anchors: the error of the lengths at {} places, "
                 "{:.2f} mm per belt, has no listed cause.",
                 d.belts->places.size(), d.belts->residual_sigma_mm) +
             short_of_a_name(d);
  }
}

/// Lengths counted from the belt's end show as an offset that all four need.
std::string left_out_arms(const BeltMachine& machine, const Diagnosis& d) {
  // Error of arm and extension: a tape measures the arm better.
  constexpr double kEqualWithin = 0.1;
  const double reach = reach_mm(machine);
  for (const Cause& c : d.causes) {
    if (c.cause.effect != &model::belts::belt_zero || c.cause.side != EffectSide::all) continue;
    const double offset = c.parameters.front().value;
    if (std::abs(offset + reach) < kEqualWithin * reach &&
        machine.lengths != model::BeltLengths::belt) {
      return fmt::format(
          "The lengths do not include arm and extension ({:.0f} mm in the settings; all lengths "
          "are {:.0f} mm too short): set \"lengths\": \"belt\", or import with --lengths belt, and "
          "diagnose again.",
          reach, -offset);
    }
  }
  return "";
}

bool tells(const BeltsNext& next) {
  return !next.measurements.empty() &&
         next.measurements.back().raises_probability_to >= kWorthMeasuring;
}

/// For undecided causes: the proposed measurements, or what would separate them if none of these
/// does.
std::string next_words(const BeltsNext& next, const Diagnosis& d) {
  std::vector<std::string> said;
  double reached = 0.0;
  if (tells(next)) {
    const NextMeasurement& first = next.measurements.front();
    reached = next.measurements.back().raises_probability_to;
    said.push_back(next_in_words(
        d,
        fmt::format("{} at ({:.0f}, {:.0f}) mm", first.words, first.mark->x_mm, first.mark->y_mm),
        next.measurements));
    if (reached < kLikelierThanNot) {
      said.emplace_back(
          "The remaining causes are too close to the noise for so few places: measure at more, out "
          "to the corners of the frame.");
    }
  }
  const double all = next.all_once_more.value_or(0.0);
  if (next.second_pass) {
    said.push_back(in_words(*next.second_pass));
  } else if (all >= kWorthMeasuring && all > reached + kWorthASession) {
    said.push_back(fmt::format(
        "{}: measuring every place again, the last one first, raises the chance of {} to {}.",
        said.empty() ? "A few places do not separate the remaining causes" : "More", aim_of(d),
        percent(all)));
  }
  if (!said.empty()) return fmt::format("{}", fmt::join(said, " "));
  if (!next.measurements.empty()) {
    return "A few places do not separate the remaining causes, which are too close to the noise: "
           "measure at more places, out to the corners of the frame.";
  }
  return fmt::format("No further lengths separate the remaining causes{}: inspect the parts.",
                     d.causes.empty() ? "" : ", because their effects are nearly the same");
}

void advise(const MeasuredBelts& belts, const BeltsNext& next, Diagnosis& d) {
  std::vector<std::string>& steps = d.what_to_do;
  if (std::string arms = left_out_arms(belts.machine, d); !arms.empty()) {
    steps.push_back(std::move(arms));
  } else {
    say_remedies(d);
  }
  if (!d.outliers.empty()) {
    steps.push_back(
        fmt::format("Do not trust {}: let the machine measure there again.", outliers_in_words(d)));
  }
  if (const Law* law = claimed_law(d)) {
    steps.push_back(
        fmt::format("Inspect the {} belt and everything that it runs over for something with this "
                    "place or period. Then let the machine measure other places to confirm or rule "
                    "it out.",
                    words(belt_of(law->enters).value())));
  }
  if (next.is_open) steps.push_back(next_words(next, d));
  if (d.belts->scale) return;
  if (!belts.distances.empty()) {
    steps.emplace_back(
        "Tape the distances again: no frame fits them together with the causes, so the scale is "
        "unknown.");
    return;
  }
  const bool proposed =
      !d.next_measurements.empty() && d.next_measurements.back().kind == MeasurementKind::distance;
  steps.push_back(fmt::format(
      "Tape {}, and enter it under distances: belts do not show the size of the frame.",
      proposed ? d.next_measurements.back().words
               : "one long distance, between two anchors or two holes that the machine cut"));
}

/// The machine's own number and this one, and why they differ.
std::string firmware_words(const BeltsAnalysis& a, const Diagnosis& d) {
  const std::optional<FirmwareFit>& machine = a.measured.firmware_fit;
  return fmt::format(
      "\"Find Anchors fit: rms\"{}{:.2f} mm by its formula. It divides by all {} readings, but "
      "there "
      "are only {} degrees of freedom: the error of one belt's reading is {:.2f} mm{}.",
      machine ? fmt::format(": the machine printed {:.2f} mm; anchors alone make ", machine->rms_mm)
              : " for these readings would be ",
      a.before.rms_mm, 4 * a.belts.points.size(), a.before.checks, a.before.residual_sigma_mm,
      d.causes.empty()
          ? ""
          : fmt::format(", with {} by {:.2f} mm", d.causes.size() == 1 ? "the cause" : "the causes",
                        d.belts->residual_sigma_mm));
}

}  // namespace

std::string in_words(const SecondPass& pass) {
  return fmt::format(
      "A second pass: let the machine find its anchors again with the belts pulled {:g} times as "
      "hard (Maslow_Calibration_Current_Threshold times {:g}), and give both logs as one session: "
      "chaintrue import maslow4 first.log second.log --pulls 1,{:g}. That separates causes that "
      "yield with the pull from others: the chance of a single name is {}.",
      pass.times, pass.times, pass.times, percent(pass.raises_probability_to));
}

std::vector<NextMeasurement> measurements_of(const BeltsAnalysis& a, const BeltsNext& next,
                                             const PointIndices& indices) {
  std::vector<NextMeasurement> list;
  if (tells(next)) list = next.measurements;
  const auto tape = a.before.scale ? std::nullopt : distance_for_scale(a.measured, a.before);
  if (!tape) return list;
  NextMeasurement distance{
      MeasurementKind::distance,
      fmt::format("the distance from {} to {}, after which the scale is known to "
                  "{:.2g} %",
                  words_of(tape->distance.from, indices), words_of(tape->distance.to, indices),
                  100.0 * tape->sigma),
      "", std::nullopt, tape->distance.sigma_mm};
  distance.from = end_of(tape->distance.from, indices);
  distance.to = {end_of(tape->distance.to, indices)};
  // This distance does not discriminate between causes.
  const Decision& decision = a.decision;
  distance.raises_probability_to = !list.empty() ? list.back().raises_probability_to
                                   : decision.listed.empty()
                                       ? std::min(1.0, decision.nothing + decision.outliers)
                                       : decision.marginal.front().probability;
  list.push_back(std::move(distance));
  return list;
}

void put_into_words(const BeltsAnalysis& a, const BeltsNext& next, Diagnosis& d) {
  d.notes.push_back(firmware_words(a, d));
  d.sentence = sentence(d);
  d.not_proved = not_proved_in_words(d);
  advise(a.measured, next, d);
}

}  // namespace chaintrue::grid::diagnosis
