// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/diagnosis_sections.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "model/effects/effect.hpp"

namespace chaintrue::cli {
namespace {

struct HypothesisWords {
  std::string_view word;
  std::string_view words;
};

constexpr HypothesisWords kHypotheses[] = {{"nothing", "nothing hidden"},
                                           {"unknown", "an unknown pattern"},
                                           {"law", "a law that no listed cause has"},
                                           {"noise", "readings worse than entered"},
                                           {"bad_points", "bad points alone"}};

/// A reading covers this many of the file's quantity, in this unit.
struct ReadingUnit {
  double count;
  std::string_view unit;
};
constexpr ReadingUnit kReadings[] = {
    {1.0, "mm"}, {1.0, "kg"}, {100.0, "mm"},        {1.0, "mm"},
    {1.0, "mm"}, {1.0, "kg"}, {1.0, "mm per metre"}};  // by ReadingOf

std::string spaced(std::string_view id) {
  std::string text(id);
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

std::string title(std::string_view id, std::string_view side) {
  return side.empty() ? spaced(id) : fmt::format("{}, {}", spaced(id), side);
}

bool same_place(const MarkPoint& a, const MarkPoint& b) {
  return a.x_mm == b.x_mm && a.y_mm == b.y_mm;
}

bool same_place(const NextMeasurement& a, const NextMeasurement& b) {
  return a.mark && b.mark && same_place(*a.mark, *b.mark);
}

/// A share or probability: 100 % and 0 % only if exact, else "below 0.1 %".
std::string share_percent(double share) {
  if (share > 0.0 && share < 0.001) return "below 0.1 %";
  const double in_percent = 100.0 * share;
  return fmt::format("{:.{}f} %", in_percent, in_percent < 9.95 ? 1 : 0);
}

std::string reading_in_words(const NextMeasurement& next) {
  std::string text = fmt::format("Measure {}", diagnosis::reading_words(*next.reading, next.side));
  const auto& [count, unit] = kReadings[as_size(*next.reading)];
  if (next.sigma > 0.0) text += fmt::format(", to {:g} {}", count * next.sigma, unit);
  if (count > 1.0) text += fmt::format("; divide it by {:g} for the file", count);
  return text + ".";
}

/// `again`: an earlier one is at the same place.
std::string follow_up_in_words(const NextMeasurement& next, bool again, bool by_belts) {
  if (next.kind == MeasurementKind::reading) return reading_in_words(next);
  if (next.kind == MeasurementKind::distance) return capitalised(next.words) + ".";
  std::string text = again && !by_belts ? "the same place, lifting the sled first" : next.words;
  if (text.empty() || text.back() != '.') text += '.';
  if (!next.mark) return text;
  const std::string place =
      fmt::format("({:.0f}, {:.0f})", next.mark->x_mm + 0.0, next.mark->y_mm + 0.0);
  return text.find(place) != std::string::npos ? text : fmt::format("{}: {}", place, text);
}

}  // namespace

std::string cause_title(const diagnosis::CauseId& cause) {
  return title(cause.effect->id, name(cause.side));
}

std::string cause_title(const AppliedEffect& effect) { return title(effect.effect, effect.side); }

std::vector<Cause> causes_left_out(const Diagnosis& found) {
  std::vector<Cause> left_out = found.causes;
  std::erase_if(left_out, [&](const Cause& cause) {
    // Effects stated in the machine file have no probability.
    const auto is_it = [&](const AppliedEffect& one) {
      return one.probability && one.effect == cause.cause.effect->id &&
             one.side == name(cause.cause.side);
    };
    return any_of(found.extended_machine.effects, is_it) || any_of(found.data_corrections, is_it);
  });
  return left_out;
}

std::string hypothesis_title(const Hypothesis& hypothesis) {
  for (const HypothesisWords& known : kHypotheses) {
    if (known.word == hypothesis.effect) return std::string(known.words);
  }
  return title(hypothesis.effect, hypothesis.side);
}

std::string point_name(std::size_t index) { return fmt::format("point {}", index + 1); }

bool is_of_distances(const Diagnosis& found) {
  return found.observations == Observations::distances;
}

std::string_view files_in_words(const Diagnosis& found) {
  constexpr std::string_view kFiles[] = {"GRID", "HOLES", "GRID --with HOLES", "BELTS",
                                         "DRAWING"};  // by Observations
  return kFiles[as_size(found.observations)];
}

std::string readings_counted(const Diagnosis& found) {
  const std::string points = fmt::format("{} points", found.points.size());
  const std::string distances = fmt::format("{} distances", found.distances.size());
  switch (found.observations) {
    case Observations::points:
      return points;
    case Observations::distances:
      return distances;
    case Observations::belts:
      return fmt::format("{} places", found.belts ? found.belts->places.size() : 0);
    case Observations::drawing:
      return fmt::format("{} measures", found.drawing ? found.drawing->measures.size() : 0);
    case Observations::both:
      break;
  }
  return points + " and " + distances;
}

bool is_distance(const Diagnosis& found, const Outlier& bad) {
  return is_of_distances(found) || bad.of == Observations::distances;
}

std::string distance_name(const Diagnosis& found, std::size_t index) {
  for (const auto& distance : found.distances) {
    if (distance.index == index) return "distance " + words_of_ends(distance);
  }
  return fmt::format("distance {}", index + 1);
}

std::string bound_in_words(const diagnosis::Bound& bound) {
  if (bound.parameter == "links" && bound.upper_95 == 0.0) return "not one link";
  if (bound.parameter == "teeth" && bound.upper_95 == 0.0) return "not one tooth";
  return in_workshop_units(bound.cause, {bound.parameter, bound.upper_95, 0.0});
}

bool is_surprising(const LeftOver& left_over) {
  constexpr double kSurprising = 0.01;
  return left_over.p_value < kSurprising;
}

std::string left_over_sentence(const LeftOver& left_over) {
  if (!is_surprising(left_over)) {
    return fmt::format("The residual looks like noise: noise alone gives as much in {} of cases.",
                       share_percent(left_over.p_value));
  }
  std::string text = fmt::format(
      "The residual exceeds noise: it is {:.1f} times the noise, and noise alone gives as much in "
      "{} of cases.",
      left_over.signal_to_noise, share_percent(left_over.p_value));
  if (!left_over.follows.empty()) {
    text +=
        fmt::format(" It follows {} best ({} of its mean square): look there.",
                    diagnosis::coordinate_words(left_over.follows), share_percent(left_over.share));
  }
  return text;
}

std::string chance_then(const Diagnosis& diagnosis, std::size_t position) {
  const NextMeasurement& next = diagnosis.next_measurements.at(position);
  if (diagnosis.belts && next.kind == MeasurementKind::distance) return "";
  return fmt::format(" {} then has probability {}.",
                     diagnosis.causes.empty() ? "One explanation alone" : "A single right name",
                     percent(next.raises_probability_to));
}

Words follow_ups_in_words(const Diagnosis& diagnosis) {
  Words sentences;
  const auto& list = diagnosis.next_measurements;
  for (const auto i : each_index(list)) {
    const bool again =
        std::any_of(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(i),
                    [&](const auto& earlier) { return same_place(earlier, list[i]); });
    sentences.push_back(follow_up_in_words(list[i], again, diagnosis.belts.has_value()));
  }
  return sentences;
}

std::vector<FollowUpPlace> follow_up_places(const Diagnosis& diagnosis) {
  std::vector<FollowUpPlace> places;
  const auto& list = diagnosis.next_measurements;
  for (const auto i : each_index(list)) {
    if (!list[i].mark) continue;
    auto* known = find_where(
        places, [&](const auto& place) { return same_place(place.mark, *list[i].mark); });
    if (known != nullptr) {
      known->numbers += fmt::format(", {}", i + 1);
      known->raises_probability_to = list[i].raises_probability_to;
    } else {
      places.push_back(
          {fmt::format("{}", i + 1), *list[i].mark, list[i].words, list[i].raises_probability_to});
    }
  }
  return places;
}

std::string bad_belt_in_words(const Outlier& bad) {
  if (!bad.belt)
    return fmt::format("point {}: more than one of its belts disagrees", bad.index + 1);
  std::string text =
      fmt::format("the {} belt at point {}: read {} ({:.1f} sigmas)", words(*bad.belt),
                  bad.index + 1, off_in_words(bad.residual_mm), bad.distance);
  if (bad.or_belt) {
    text += fmt::format("; or the {} one, which looks the same at this place", words(*bad.or_belt));
  }
  return text;
}

}  // namespace chaintrue::cli
