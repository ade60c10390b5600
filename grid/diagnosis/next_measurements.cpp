// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_measurements.hpp"

#include <algorithm>

#include "grid/containers.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// An explanation as likely as this is left alone where none is named: nothing hidden keeps 0.93 in
/// the median session of 28 points.
constexpr double kLeftAlone = 0.9;
constexpr double kPays = 0.002;  // a measurement that helps less is not worth the way

/// The reading that tells members of one class apart which no points can: a chain's links.
void add_link_reading(const Analysis& a, std::vector<NextMeasurement>& list) {
  if (a.decision.listed.empty() || list.size() >= kMostNextMeasurements) return;
  const CauseClass& members = a.decision.classes[a.decision.listed.front()];
  const bool pitch = any_of(members, [](const CauseId& c) {
    return c.effect->elongation != nullptr && c.effect->law == nullptr;
  });
  const auto proposes_it = [](const NextMeasurement& next) {
    return next.reading == ReadingOf::link_pitch;
  };
  const auto is_pitch = [](const ExtraReading& taken) {
    return taken.what == ReadingOf::link_pitch;
  };
  if (members.size() < 2 || !pitch || any_of(list, proposes_it) ||
      any_of(a.session.readings(), is_pitch)) {
    return;
  }
  NextMeasurement reading{MeasurementKind::reading, "", "left", std::nullopt, kLinkPitchSigmaMm};
  reading.reading = ReadingOf::link_pitch;
  for (const ClassProbability& one : a.decision.marginal) {
    if (one.index == a.decision.listed.front()) reading.raises_probability_to = one.probability;
  }
  if (!list.empty()) reading.raises_probability_to = list.back().raises_probability_to;
  list.push_back(std::move(reading));
}

/// Of the most probable group.
double share_of_best(const std::vector<Alternative>& alternatives) {
  double sum = 0.0;
  for (const Alternative& one : alternatives) sum += one.group == 0 ? one.probability : 0.0;
  return sum;
}

}  // namespace

bool is_left_alone(const Analysis& a, const std::vector<Alternative>& alternatives) {
  return alternatives.empty() ||
         (a.decision.listed.empty() && share_of_best(alternatives) > kLeftAlone);
}

std::vector<NextMeasurement> most_telling(const std::vector<Alternative>& alternatives,
                                          std::vector<Candidate> options,
                                          bool is_named) {
  std::vector<NextMeasurement> result;
  std::vector<Eigen::Index> chosen;
  ExpectedDiscrimination now = expected_discrimination(alternatives, chosen);
  double reached = is_named ? kEnough : now.named_alone;
  while (result.size() < kMostNextMeasurements && reached < kEnough) {
    std::size_t best = options.size();
    ExpectedDiscrimination then = now;
    for (std::size_t c = 0; c < options.size(); ++c) {
      if (options[c].times == 0) continue;
      std::vector<Eigen::Index> more = chosen;
      append_all(more, options[c].rows);
      const ExpectedDiscrimination tried = expected_discrimination(alternatives, more);
      if (tried.confusion < then.confusion) {
        then = tried;
        best = c;
      }
    }
    if (best == options.size() || now.confusion - then.confusion < kPays * now.confusion) break;
    options[best].times -= 1;
    append_all(chosen, options[best].rows);
    // The Gaussian approximation may dip where the first points only raise doubts; more data never
    // make the right name less likely in the mean.
    reached = std::max(reached, then.named_alone);
    result.push_back(options[best].measurement);
    result.back().raises_probability_to = reached;
    now = then;
  }
  return result;
}

std::vector<NextMeasurement> next_measurements(const Analysis& a) {
  NextCandidates next = next_candidates(a);
  const auto alternatives = alternatives_about(a, next.session);
  if (!alternatives || is_left_alone(a, *alternatives)) return {};
  std::vector<NextMeasurement> result = most_telling(
      *alternatives, std::move(next.all), a.decision.verdict == Verdict::named);
  add_link_reading(a, result);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
