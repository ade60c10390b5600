// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/diagnosis/belts_report.hpp"
#include "grid/diagnosis/constants.hpp"
#include "grid/diagnosis/workshop_units.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

std::string sized(const CauseId& cause, const std::vector<ParameterEstimate>& parameters) {
  std::string text = fmt::format("{}{} (", cause.effect->cause, side_words(cause));
  for (const ParameterEstimate& own : parameters) {
    if (&own != &parameters.front()) text += ", ";
    text += in_workshop_units(cause, own);
  }
  return text + ")";
}

std::vector<std::string> bad_ones(const Diagnosis& d) {
  std::vector<std::string> result;
  for (const Outlier& bad : d.outliers) {
    result.push_back(
        bad.belt ? fmt::format("the {} belt at point {}, read {:.1f} mm too {}",
                               model::words(*bad.belt),
                               bad.index,
                               std::abs(bad.off_mm),
                               bad.off_mm > 0.0 ? "long" : "short")
                 : fmt::format("point {}, where more than one belt disagrees", bad.index));
  }
  return result;
}

std::string gain_words(const BeltsFindings& found) {
  std::string text = fmt::format(" What one belt's reading is off by falls from {:.2f} to {:.2f} mm",
                                 found.spread_before_mm,
                                 found.spread_mm);
  if (found.foretold && found.foretold_before) {
    text += fmt::format(
        "; the lower belts, foretold by the upper two at places left out, from {:.2f} to {:.2f} mm",
        found.foretold_before->rms_mm,
        found.foretold->rms_mm);
  }
  return text + ".";
}

/// " Besides, 0.4 mm of each reading ..."
std::string besides_words(const Diagnosis& d) {
  if (!d.unexplained || d.unexplained->probability <= kDiscrepancyLikely) return "";
  return fmt::format(
      " Besides, {:.2f} mm a belt follow a pattern over some {:.0f} mm of the sheet that no listed "
      "cause makes: {}.",
      d.unexplained->rms_mm,
      d.unexplained->length_mm,
      percent(d.unexplained->probability));
}

std::string named_words(const Diagnosis& d) {
  const Cause& cause = d.causes.front();
  std::string text = fmt::format("Most likely {}: probability {}.",
                                 sized(cause.cause, cause.parameters),
                                 percent(cause.probability));
  for (const SameCause& other : cause.same_as) {
    text += fmt::format(" No lengths of belts can tell it from this: {}.",
                        sized(other.cause, other.parameters));
  }
  return text;
}

std::string listed_words(const Diagnosis& d, std::string_view last) {
  std::vector<std::string> parts;
  for (const Cause& c : d.causes) {
    parts.push_back(fmt::format("{}, {}", sized(c.cause, c.parameters), percent(c.probability)));
  }
  return joined(parts, last);
}

std::string sentence(const Diagnosis& d) {
  switch (d.verdict) {
    case Verdict::named:
      return named_words(d) + besides_words(d) + gain_words(*d.belts);
    case Verdict::named_set:
      return fmt::format("One of {} causes, which these lengths do not tell apart: {}.",
                         d.causes.size(),
                         listed_words(d, "or")) +
             besides_words(d) + gain_words(*d.belts);
    case Verdict::several_causes:
      return fmt::format(
                 "{} causes act together: {}.", d.causes.size(), listed_words(d, "and")) +
             besides_words(d) + gain_words(*d.belts);
    case Verdict::outliers:
      return fmt::format("Nothing is wrong but {} of the readings: {}. Without {} the frame fits.",
                         d.outliers.size(),
                         joined(bad_ones(d), "and"),
                         d.outliers.size() == 1 ? "it" : "them");
    case Verdict::model_discrepancy:
      return fmt::format(
          "What is left of the lengths changes smoothly from place to place, {:.2f} mm a belt over "
          "some {:.0f} mm of the sheet, and no listed cause makes it.",
          d.unexplained->rms_mm,
          d.unexplained->length_mm);
    default:
      return fmt::format(
          "Nothing is found beyond the anchors: what is left of the lengths at {} places, {:.2f} mm "
          "a belt, has no listed cause.",
          d.belts->places.size(),
          d.belts->spread_mm);
  }
}

/// Lengths that count from the belt's end: known by the offset that all four need.
std::string left_out_arms(const MeasuredBelts& belts, const Diagnosis& d) {
  // Of arm and extension: a tape finds the arm to less.
  constexpr double kAlike = 0.1;
  const double reach = model::reach_mm(belts.machine);
  for (const Cause& c : d.causes) {
    if (c.cause.effect->id != "belt_zero" || c.cause.side != model::effects::EffectSide::all)
      continue;
    const double offset = c.parameters.front().value;
    if (std::abs(offset + reach) < kAlike * reach && belts.machine.lengths != model::BeltLengths::belt) {
      return fmt::format(
          "The lengths leave arm and extension out ({:.0f} mm are stated, all are {:.0f} mm too "
          "short): state \"lengths\": \"belt\", or import with --lengths belt, and diagnose again.",
          reach,
          -offset);
    }
  }
  return "";
}

void say_what_to_do(const MeasuredBelts& belts, Diagnosis& d) {
  const std::string arms = left_out_arms(belts, d);
  if (!arms.empty()) d.what_to_do.push_back(arms);
  for (const Cause& c : d.causes) {
    if (d.what_to_do.size() >= 2 || d.verdict == Verdict::named_set || !arms.empty()) break;
    d.what_to_do.emplace_back(c.cause.effect->remedy);
  }
  if (!d.outliers.empty()) {
    d.what_to_do.push_back(
        fmt::format("Do not trust {}: let the machine measure there again.",
                    joined(bad_ones(d), "and")));
  }
  if (!d.belts->scale) {
    d.what_to_do.emplace_back(
        "Tape one long distance, between two anchors or two holes that the machine cut, and give it "
        "as distances: no belt knows how large the frame is.");
  }
}

std::string not_proved(const Diagnosis& d) {
  std::string text =
      d.causes.empty()
          ? "This does not prove the machine perfect: causes smaller than their bounds below would "
            "not have shown."
          : "Lengths show what fits, not what is: look at the part before changing it.";
  if (!d.causes.empty() && d.causes.front().rival) {
    const Cause& lead = d.causes.front();
    text += fmt::format(
        " A cause outside the list that looks alike would carry the same name; the nearest inside "
        "it is this: {}{} (likeness {:.3f}).",
        lead.rival->effect->cause,
        side_words(*lead.rival),
        lead.rival_collinearity);
  }
  return text;
}

/// The machine's own number beside ours, and why they differ.
std::string firmware_words(const MeasuredBelts& belts, const BeltsFit& alone, const Diagnosis& d) {
  const auto readings = static_cast<double>(4 * belts.points.size());
  std::string text;
  if (belts.firmware_fit) {
    text = fmt::format("\"Find Anchors fit: rms\": the machine said {:.2f} mm; ",
                       belts.firmware_fit->rms_mm);
  } else {
    text = "\"Find Anchors fit: rms\" of these readings would say ";
  }
  return text + fmt::format(
                    "{}{:.2f} mm by its count. It divides by all {:.0f} readings, of which only {} "
                    "are free to disagree: one belt's reading is off by {:.2f} mm{}.",
                    belts.firmware_fit ? "anchors alone make " : "",
                    alone.rms_mm,
                    readings,
                    alone.checks,
                    alone.spread_mm,
                    d.causes.empty() ? ""
                                     : fmt::format(", with {} beside the anchors by {:.2f} mm",
                                                   d.causes.size() == 1 ? "the cause" : "the causes",
                                                   d.belts->spread_mm));
}

}  // namespace

void put_belts_into_words(const MeasuredBelts& belts, const BeltsFit& alone, Diagnosis& d) {
  d.notes.push_back(firmware_words(belts, alone, d));
  d.sentence = sentence(d);
  d.not_proved = not_proved(d);
  say_what_to_do(belts, d);
}

}  // namespace chaintrue::grid::diagnosis
