// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/verdict_words.hpp"

#include <fmt/format.h>

#include "grid/diagnosis/law_words.hpp"
#include "grid/diagnosis/laws.hpp"
#include "grid/diagnosis/workshop_units.hpp"

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
  return kVocabularies[static_cast<std::size_t>(d.observations)];
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
      return fmt::format(
          "the {} belt at point {}{}, read {}", model::words(*bad.belt), bad.index + 1,
          bad.or_belt ? fmt::format(", or the {} one", model::words(*bad.or_belt)) : "",
          off_in_words(bad.residual_mm));
    default:
      return fmt::format("{}{}", d.observations == Observations::both ? "point " : "",
                         bad.index + 1);
  }
}

}  // namespace

std::string causes_in_words(const Diagnosis& d) {
  std::vector<std::string> parts;
  for (const Cause& c : d.causes)
    parts.push_back(fmt::format("{}, {}", sized(c.cause, c.parameters), percent(c.probability)));
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
  std::vector<std::string> all;
  for (const Outlier& bad : d.outliers) all.push_back(outlier_words(d, bad));
  return joined(all, "and");
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

}  // namespace chaintrue::grid::diagnosis
