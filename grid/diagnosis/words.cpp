// SPDX-License-Identifier: GPL-3.0-or-later

#include <fmt/format.h>

#include "grid/diagnosis/findings.hpp"
#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/stability.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "grid/observation/measured_holes.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Words for a kind of readings and its machine.
struct Vocabulary {
  std::string_view readings;   ///< that do not distinguish causes
  std::string_view one_each;   ///< some of which are bad
  std::string_view bad;        ///< before the bad ones' names
  std::string_view capital;    ///< before "show what fits"
  std::string_view undecided;  ///< before "tell it from this"
  std::string_view besides;
  std::string_view whole;  ///< what fits without outliers
};

/// Indexed by Observations.
constexpr Vocabulary kVocabularies[] = {
    {"points", "points", "number ", "Points", "These points cannot", "Also", "machine"},
    {"distances", "distances", "", "Distances", "These distances cannot", "Also", "machine"},
    {"readings", "readings", "", "Readings", "These readings cannot", "Also", "machine"},
    {"lengths", "readings", "", "Lengths", "No lengths of belts can", "Besides", "frame"},
    {"measures", "measures", "", "Readings", "These measures cannot", "Also", "machine"}};

const Vocabulary& vocabulary_of(const Diagnosis& d) {
  return kVocabularies[as_size(d.observations)];
}

/// "; besides, a pattern of 0.4 mm that follows x, which no listed cause makes".
std::string alongside_words(const Diagnosis& d) {
  const std::string_view besides = vocabulary_of(d).besides;
  if (const Law* law = claimed_law(d)) {
    return fmt::format(" {}, something that no listed cause explains: {}, {}.", besides,
                       in_words(*law), percent(law->probability)) +
           given_law_words(d);
  }
  if (!d.unexplained || d.unexplained->probability <= kDiscrepancyLikely) return "";
  const Unexplained& left = *d.unexplained;
  const std::string probability = percent(left.probability);
  if (d.belts) {
    return fmt::format(
        " {}, the errors, {:.2f} mm per belt, form a pattern over about {:.0f} mm of the sheet "
        "that "
        "no listed cause explains: {}.",
        besides, left.rms_mm, left.length_mm, probability);
  }
  return fmt::format(
      " {}, a pattern of {:.2f} mm{}, which no listed cause explains: {}.", besides, left.rms_mm,
      left.follows.empty()
          ? fmt::format(" that changes over about {:.0f} mm of the bed", left.length_mm)
          : fmt::format(" that follows {}", coordinate_words(left.follows)),
      probability);
}

std::string outlier_words(const Diagnosis& d, const Outlier& bad) {
  switch (bad.of) {
    case Observations::drawing:
      return d.drawing->measures.at(bad.index).name;
    case Observations::distances:
      return fmt::format("{} (read {})", words_of_ends(d.distances.at(bad.index)),
                         off_in_words(bad.residual_mm));
    case Observations::belts:
      if (!bad.belt)
        return fmt::format("point {}, where more than one belt disagrees", bad.index + 1);
      return fmt::format("the {} belt at point {}{}, read {}", words(*bad.belt), bad.index + 1,
                         bad.or_belt ? fmt::format(", or the {} one", words(*bad.or_belt)) : "",
                         off_in_words(bad.residual_mm));
    default:
      return fmt::format("{}{}", d.observations == Observations::both ? "point " : "",
                         bad.index + 1);
  }
}

}  // namespace

std::string causes_in_words(const Diagnosis& d) {
  const auto parts = mapped(d.causes, [&](const Cause& c) {
    return fmt::format("{}, {}", sized(c.cause, c.parameters), percent(c.probability));
  });
  const Vocabulary& words = vocabulary_of(d);
  std::string text;
  if (d.verdict == Verdict::named) {
    const Cause& cause = d.causes.front();
    text = fmt::format("Most likely {}: probability {}.", sized(cause.cause, cause.parameters),
                       percent(cause.probability));
    for (const SameCause& other : cause.same_as) {
      text += fmt::format(
          " {} distinguish it from this: "
          "{}.",
          words.undecided, sized(other.cause, other.parameters));
    }
  } else if (d.verdict == Verdict::named_set) {
    text = fmt::format("One of {} causes that these {} do not distinguish: {}.", parts.size(),
                       words.readings, joined(parts, "or"));
  } else if (d.verdict == Verdict::several_causes) {
    text = fmt::format("{} causes act together: {}.", parts.size(), joined(parts, "and"));
  } else {
    return "";
  }
  return text + alongside_words(d);
}

std::string claimed_law_in_words(const Diagnosis& d) {
  const Law* law = claimed_law(d);
  if (law == nullptr) return "";
  return fmt::format(
             "The {} follow a law that no cause in the catalogue has: {}, {}. On average it {}.",
             vocabulary_of(d).readings, in_words(*law), percent(law->probability),
             average_in_words(*law, d.observations)) +
         given_law_words(d);
}

std::string outliers_in_words(const Diagnosis& d) {
  return joined(mapped(d.outliers, [&](const Outlier& bad) { return outlier_words(d, bad); }),
                "and");
}

std::string only_outliers_in_words(const Diagnosis& d) {
  const Vocabulary& words = vocabulary_of(d);
  return fmt::format("Nothing is wrong but {} of the {}: {}{}. Without {} the {} fits.",
                     d.outliers.size(), words.one_each, words.bad, outliers_in_words(d),
                     d.outliers.size() == 1 ? "it" : "them", words.whole);
}

void say_remedies(Diagnosis& d) {
  if (d.verdict == Verdict::named_set) return;
  for (std::string& remedy : remedies(d.causes)) {
    if (d.what_to_do.size() < 2) d.what_to_do.push_back(std::move(remedy));
  }
}

std::string_view aim_of(const Diagnosis& d) {
  return d.causes.empty() ? "one explanation alone" : "a single name";
}

std::string next_in_words(const Diagnosis& d, std::string_view first,
                          const std::vector<NextMeasurement>& all) {
  return fmt::format("Measure next: {}{}. All of it raises the chance of {} to {}.", first,
                     all.size() > 1 ? fmt::format(", and {} more below", all.size() - 1) : "",
                     aim_of(d), percent(all.back().raises_probability_to));
}

std::string not_proved_in_words(const Diagnosis& d) {
  const Vocabulary& words = vocabulary_of(d);
  if (!d.causes.empty()) {
    const std::optional<CauseId>& rival = d.causes.front().rival;
    return fmt::format(
        "{} show which explanation fits, not that it is true. Inspect the part "
        "before changing it.{}",
        words.capital,
        rival ? fmt::format(" An unlisted cause with the same effect would get the same name. The "
                            "most similar listed one: {}.",
                            sized(*rival, {}))
              : "");
  }
  if (d.verdict != Verdict::model_discrepancy || d.belts) {
    return "That the machine is perfect. Causes smaller than their bounds below would not have "
           "shown.";
  }
  return claimed_law(d) != nullptr
             ? "A law states what the error depends on, not its cause; other causes may act as "
               "well."
             : "No cause in the catalogue explains it, but one may still act as well.";
}

namespace {

/// The held-out quantity: distances if no chain was read at marks.
bool speaks_of_distances(const Diagnosis& d) { return d.observations == Observations::distances; }

std::string improvement_words(const Diagnosis& d) {
  if (!d.improvement) return "";
  if (d.improvement->extended.rms_mm >= d.improvement->calibrated.rms_mm) {
    return fmt::format(
        " Correcting for it does not improve {}: left-out readings are predicted to {:.2f} mm with "
        "and without it, and the scatter of the readings is {:.2f} mm. The machine is therefore "
        "left unchanged.",
        speaks_of_distances(d) ? "distances" : "the tool", d.improvement->calibrated.rms_mm,
        d.improvement->noise_floor_mm);
  }
  return fmt::format(
      " Correcting for it reduces the {} error at left-out readings from {:.2f} to {:.2f} mm; the "
      "scatter of the readings is {:.2f} mm.",
      speaks_of_distances(d) ? "distances'" : "tool's", d.improvement->calibrated.rms_mm,
      d.improvement->extended.rms_mm, d.improvement->noise_floor_mm);
}

std::string assumed_words(const Diagnosis& d) {
  const bool assumed = any_of(d.causes, &Cause::order_assumed);
  return assumed ? " This assumes the order of the visits." : "";
}

std::string unknown_words(const Diagnosis& d) {
  if (claimed_law(d) != nullptr) return claimed_law_in_words(d);
  std::string text =
      !speaks_of_distances(d)
          ? fmt::format(
                "The {} show a pattern that repeats over the bed and that no cause in the "
                "catalogue explains",
                name(d.observations))
          : "The holes are off the positions that follow from their chain lengths, by more than "
            "the scatter of the readings and by similar amounts for neighbours, and no known cause "
            "explains it";
  if (!d.left_over.follows.empty()) {
    text += fmt::format("; it follows {} best ({:.0f} % of it)",
                        coordinate_words(d.left_over.follows), 100.0 * d.left_over.share);
  }
  return text + ".";
}

/// "zero left (0.00 mm set, 23.08 +- 1.99 found)", for each that is off.
std::vector<std::string> settings_off(const Diagnosis& d) {
  std::vector<std::string> off;
  if (!d.drawing) return off;
  for (const DrawnSetting& own : d.drawing->settings) {
    if (!own.off) continue;
    const NameAndUnit words = parameter_words(own.name);
    off.push_back(fmt::format("{} ({:.2f} {} set, {:.2f} +- {:.2f} found)", words.name, own.set,
                              words.unit, own.found, own.sigma));
  }
  return off;
}

std::string bad_words(const Diagnosis& d) {
  const std::vector<std::string> off = settings_off(d);
  if (off.empty()) return only_outliers_in_words(d);
  return fmt::format("{} of the {} fit nothing: {}. Without {} {} off: {}.", d.outliers.size(),
                     name(d.observations), outliers_in_words(d),
                     d.outliers.size() == 1 ? "it" : "them",
                     off.size() == 1 ? "a setting is" : "settings are", joined(off, "and"));
}

std::string nothing_words(const Diagnosis& d, std::size_t units) {
  if (const std::vector<std::string> off = settings_off(d); !off.empty()) {
    return fmt::format(
        "{} off, and nothing else is wrong: {}. With the numbers found, the {} {} agree to "
        "within the scatter of the readings.",
        off.size() == 1 ? "A setting is" : "Settings are", joined(off, "and"), units,
        name(d.observations));
  }
  std::string text = fmt::format(
      "Nothing is wrong apart from the settings: the remaining error {} the {} {} is within the "
      "scatter of the readings.",
      d.observations == Observations::points ? "at" : "of", units, name(d.observations));
  if (d.family_wise_p < 0.05) {
    text += fmt::format(
        " Chance alone makes the strongest effect look as strong in {:.0f} of 100 "
        "sessions.",
        100.0 * d.family_wise_p);
  }
  return text;
}

std::string sentence(const Diagnosis& d, std::size_t units) {
  switch (d.verdict) {
    case Verdict::named:
    case Verdict::named_set:
    case Verdict::several_causes:
      return causes_in_words(d) + assumed_words(d) + improvement_words(d);
    case Verdict::model_discrepancy:
      return unknown_words(d);
    case Verdict::noise_larger_than_stated:
      if (d.drawing) {
        return fmt::format(
            "The measures scatter {:.1f} times as much as a ruler, without a pattern: check the "
            "ruler, the paper and play in the gondola, and draw the page again.",
            d.noise_factor);
      }
      return fmt::format(
          "The {} scatter {:.1f} times as much as you entered, without a pattern: check the tape, "
          "the {} and play in the sled.",
          name(d.observations), d.noise_factor, speaks_of_distances(d) ? "drill" : "marking");
    case Verdict::outliers:
      return bad_words(d);
    case Verdict::nothing_found:
      break;
  }
  return nothing_words(d, units);
}

/// Before changing a part because of one reading, repeat the reading.
void advise_rereading(Diagnosis& d) {
  const Indices points = influential_points(d);
  if (points.size() != 1) return;
  const bool is_bad = any_of(d.outliers, [&](const Outlier& b) {
    return b.of == Observations::points && b.index == points.front();
  });
  if (is_bad) return;
  d.what_to_do.push_back(
      fmt::format("Measure point {} again first: the answer depends on it.", points.front() + 1));
}

std::string what_next(const NextMeasurement& next) {
  if (next.kind == MeasurementKind::reading) return reading_words(*next.reading, next.side);
  if (next.kind != MeasurementKind::point) return next.words;
  return fmt::format("a new point at ({:.0f}, {:.0f}) mm", next.mark->x_mm, next.mark->y_mm);
}

void advise(Diagnosis& d) {
  std::vector<std::string>& steps = d.what_to_do;
  const auto add_if_room = [&steps](std::string step) {
    if (steps.size() < 3) steps.push_back(std::move(step));
  };
  advise_rereading(d);
  say_remedies(d);
  const auto& next = d.next_measurements;
  if (!next.empty()) steps.push_back(next_in_words(d, what_next(next.front()), next));
  if (!d.outliers.empty()) {
    add_if_room(fmt::format("Measure {}{} again.",
                            d.observations == Observations::points      ? "point "
                            : d.observations == Observations::distances ? "the distance "
                                                                        : "",
                            outliers_in_words(d)));
  }
  for (const CalibratedSetting& s : d.settings) {
    if (!s.off) continue;
    add_if_room(fmt::format("Check {}: the machine file has {:.2f}, but {:.2f} fits the {}.",
                            name(s.setting), s.stated, s.calibrated, name(d.observations)));
  }
  if (claimed_law(d) != nullptr) {
    add_if_room(
        d.unexplained->causes_given_law.empty()
            ? "Write the law to a file (chaintrue diagnose --law), measure other points, and "
              "diagnose these with it (--effects) to confirm it or rule it out."
            : "Write the law to a file (chaintrue diagnose --law) and diagnose these "
              "readings again with it (--effects): the machine file then has the causes "
              "found together with it.");
  } else if (d.verdict == Verdict::model_discrepancy && steps.size() < 3) {
    steps.emplace_back(
        "Use the measured map (chaintrue fit): it corrects a repeating pattern, whatever its "
        "cause.");
    // More marks on the same sheet cannot show which of the two is wrong.
    steps.emplace_back(
        "Rotate the sheet by half a turn, or place the marks with a different tape, and measure "
        "again. An error that rotates with the sheet belongs to the sheet or the tape; one that "
        "stays belongs to the machine; one that disappears belonged to that session.");
  }
  if (!settings_off(d).empty()) {
    add_if_room(
        d.causes.empty()
            ? "Type the numbers in: chaintrue fit finds them, and export plotter prints the lines."
            : "Then draw the page again: chaintrue fit finds the settings that are off, and export "
              "plotter prints the lines to type in.");
  }
  if (steps.empty()) {
    steps.push_back(fmt::format("Type in the calibrated settings; these {} show nothing else.",
                                name(d.observations)));
  }
}

std::string not_proved(const ObservationSet& session, const Diagnosis& d) {
  std::string text = not_proved_in_words(d) + influence_in_words(d);
  if (speaks_of_distances(d)) {
    text +=
        " Distances do not show the order of the holes or the position of the machine as a whole, "
        "so drift, skipped teeth, play and the height of the motors cannot be found.";
  } else if (d.drawing) {
    text +=
        " A drawing does not show the order of its lines, so drift and skipped teeth cannot "
        "be found.";
  } else if (!session.ordered()) {
    text +=
        " The order of the visits is not known, so drift, skipped teeth and play cannot be "
        "found.";
  }
  return text;
}

}  // namespace

void put_into_words(const Analysis& a, Diagnosis& d) {
  const ObservationSet& session = a.session;
  if (!a.converged) {
    d.notes.emplace_back(
        "The calibration had not converged after its last pass, so the settings are less certain "
        "than their sigmas. Look for a reading that is far off, or a wrong setting.");
  }
  if (session.noise_from_repeats && d.improvement) {
    d.notes.push_back(
        fmt::format("Your readings scatter by about {:.2f} mm, judged by the marks measured twice.",
                    d.improvement->noise_floor_mm));
  }
  if (d.stability) d.notes.push_back(stability_in_words(d));
  for (std::string& note : parts_in_words(d)) d.notes.push_back(std::move(note));
  if (speaks_of_distances(d) && d.left_over.p_value < kFalseAlarm) {
    d.notes.emplace_back(
        "Neighbours are off by similar amounts. Distances do not show what they depend on, "
        "because each joins two places; marks with chain readings do.");
  }
  d.sentence = a.system.regressors.empty()
                   ? fmt::format(
                         "These {} cannot test any cause: there are too few of them, or they "
                         "scatter too much.",
                         name(d.observations))
                   : sentence(d, session.units.size());
  d.not_proved = not_proved(session, d);
  advise(d);
}

}  // namespace chaintrue::grid::diagnosis
