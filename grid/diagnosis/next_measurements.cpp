// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_measurements.hpp"

#include <algorithm>

#include "grid/diagnosis/law_model.hpp"
#include "grid/eigen.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Above this probability of no cause, no more measurements are needed: the median session of 28
/// points without a cause gives 0.93.
constexpr double kLeftAlone = 0.9;
constexpr double kPays = 0.002;  // a measurement that helps less is not worth the effort

/// The reading that separates members of one class, which no points can: a chain's links.
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
  reading.raises_probability_to = list.empty()
                                      ? a.decision.probability_of(a.decision.listed.front())
                                      : list.back().raises_probability_to;
  list.push_back(std::move(reading));
}

/// For the most probable group.
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
                                          std::vector<Candidate> options) {
  std::vector<NextMeasurement> result;
  Rows chosen;
  ExpectedDiscrimination now = expected_discrimination(alternatives, chosen);
  double reached = now.named_alone;
  while (result.size() < kMostNextMeasurements && reached < kEnough) {
    std::size_t best = options.size();
    ExpectedDiscrimination then = now;
    for (std::size_t c = 0; c < options.size(); ++c) {
      if (options[c].times == 0) continue;
      Rows more = chosen;
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
    // The Gaussian approximation may dip when the first points only raise doubts; on average more
    // data never make the right name less likely.
    reached = std::max(reached, then.named_alone);
    result.push_back(options[best].measurement);
    result.back().raises_probability_to = reached;
    now = then;
  }
  return result;
}

std::vector<NextMeasurement> next_measurements(const Analysis& a) {
  if (is_left_alone(a, alternatives_of_best(a))) return {};
  std::vector<NextMeasurement> result;
  if (a.decision.verdict != Verdict::named) {
    NextCandidates next = next_candidates(a);
    const auto alternatives = alternatives_about(a, next.session);
    if (!alternatives) return {};
    result = most_telling(*alternatives, std::move(next.all));
  }
  add_link_reading(a, result);
  return result;
}

namespace {

/// The prediction of future rows by a model of these causes and a law's amplitudes, with its columns there.
Alternative expected_with(const Analysis& a, const ObservationSet& session,
                          const RegressorSystem& next, const LawModel& model,
                          const RegressorSet& causes, const MatrixXd& law) {
  MatrixXd columns = MatrixXd::Zero(next.e.size(), std::ssize(causes) + law.cols());
  for (std::size_t k = 0; k < causes.size(); ++k) {
    if (const auto g = signature(session, a.state, next, a.system.regressor(causes[k])))
      columns.col(as_index(k)) = *g;
  }
  columns.rightCols(law.cols()) = law;
  return model.expected_of(next, columns);
}

}  // namespace

std::vector<NextMeasurement> next_for_laws(const Analysis& a, const LawsFound& found) {
  if (found.laws.empty() || found.laws.front().probability >= kEnough) return {};
  NextCandidates next = next_candidates(a);
  const auto system = linearise(next.session, a.state);
  if (!system) return {};
  std::vector<Alternative> alternatives;
  const auto add = [&](const LawModel& model, const ActsBesides& besides, const MatrixXd& law,
                       double probability) {
    Alternative one = expected_with(a, next.session, *system, model, besides.causes, law);
    one.group = alternatives.size();
    one.probability = probability;
    alternatives.push_back(std::move(one));
  };
  double none = 1.0;
  for (std::size_t k = 0; k < found.laws.size(); ++k) {
    const WeighedLaw& law = found.heaviest[k];
    add(model_with(a, law), law.with, law.columns(*system), found.laws[k].probability);
    none -= found.laws[k].probability;
  }
  // Averaging over parts of the bed may leave almost no weight for the rest.
  constexpr double kLeastOfNone = 0.01;
  const WeighedLaw& first = found.heaviest.front();
  add(model_without(a, first), first.without, MatrixXd(system->e.size(), 0),
      std::max(none, kLeastOfNone));
  normalise(alternatives);
  return most_telling(alternatives, std::move(next.all));
}

}  // namespace chaintrue::grid::diagnosis
