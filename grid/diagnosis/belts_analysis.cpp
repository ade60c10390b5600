// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_analysis.hpp"

#include <cmath>

#include "grid/failed.hpp"
#include "grid/progress.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// Prior noise of one belt's reading: 0.5 to 1 mm on four owners' frames.
constexpr double kUsualSpreadMm = 0.6;
/// Probability that noise makes some cause look as strong, below which causes are reported: a tenth
/// of the limit for chains, because the expected stretch of pulled belts is named on little
/// evidence. It costs hardly anything: of causes of strength 6 to 8, the weakest that are asked
/// for, 48 of 55 are beyond it.
constexpr double kFalseAlarmOfBelts = 0.001;
/// With a pattern, the factor by which the readings must raise the odds of a named cause:
/// "positive" evidence (R. Kass and A. Raftery, J. Am. Stat. Assoc. 90 (1995), 777).
constexpr double kSpokenFor = 3.0;
/// Places in a part of the bed: anchors need four, and one more check at each reveals a wrong one.
constexpr std::size_t kFewestPlaces = 8;
/// Linearised about no cause, about the causes found, and about what those leave.
constexpr int kRoundsOfBelts = 3;

/// Regressors of a cause that are compared; those near one visit are kept together, because an
/// anchor that slips in an untried direction also looks like a skip of another belt.
constexpr SearchLimits kSearch{.of_a_cause = 3, .one_event_visits = 4.0};
/// With more rows a pattern costs seconds: one kernel, at the end alone.
constexpr Index kManyRows = 500;
constexpr std::size_t kKernelOfMany = 1;

constexpr int kBeltWorkSteps = 2;
constexpr WorkStep kFitting{"anchors alone", 1, kBeltWorkSteps};
constexpr WorkStep kComparingBelts{"the causes against each other", 2, kBeltWorkSteps};

/// The system's regressors at the values that were found before.
RegressorSet found_before(const Analysis& a) {
  RegressorSet found;
  for (const SizedCause& own : a.known) {
    for (const int k : a.system.regressors_of(own.cause)) {
      if (a.system.regressor(k).values != own.values) continue;
      found.push_back(k);
      break;
    }
  }
  sort(found);
  return found;
}

/// The factor by which the readings raise the odds of a cause given a pattern; infinity if the
/// pattern alone is impossible.
double spoken_for(const Analysis& a, const CauseClass& members) {
  std::vector<double> with, without;
  double beforehand = 0.0;
  for (const CandidateModel& model : a.comparison.models) {
    if (model.discrepancy < 0 || model.regressors.size() > 1) continue;
    if (model.regressors.empty()) {
      without.push_back(model.log_weight);
      continue;
    }
    const Regressor& own = a.system.regressor(model.regressors.front());
    if (!contains(members, own.cause)) continue;
    with.push_back(model.log_weight);
    beforehand = log_prior(a.system, model.regressors, true) - log_prior(a.system, {}, true);
  }
  if (with.empty()) return 0.0;
  if (without.empty()) return kInfinity;
  return std::exp(log_sum(with) - log_sum(without) - beforehand);
}

/// An expected cause that the readings make no likelier is not a finding. With a pattern, where
/// less certainty suffices for a name, the pattern is the finding.
void take_expected_back(Analysis& a) {
  Decision& decision = a.decision;
  if (decision.verdict != Verdict::named || !(decision.discrepancy > kDiscrepancyLikely)) return;
  if (decision.marginal.front().probability >= kNamedAlone) return;
  const CauseClass& named = decision.classes[decision.listed.front()];
  if (spoken_for(a, named) < kSpokenFor) withdraw_names(a.comparison, decision);
}

}  // namespace

BeltRules::BeltRules(BeltsAnalysis& belts) : belts_(belts) {
  rounds = kRoundsOfBelts;
  noise = NoiseSize::unknown;
  false_alarm = kFalseAlarmOfBelts;
  hidden =
      "other anchors would hide it, whatever its size: measure at more places, spread over the "
      "sheet";
}

tl::expected<void, DiagnosisFailure> BeltRules::linearise(Analysis& a) const {
  const FrameState& frame = belts_.frame.state;
  a.session = observations_of(belts_.belts, frame, belts_.sigma_mm);
  a.session.fewest_units = kFewestPlaces;
  a.system = system_of(belts_.belts, frame, a.session, a.candidates.testable, a.known);
  return {};
}

ComparisonOptions BeltRules::compared(const Analysis& a, bool last) const {
  ComparisonOptions options;
  options.search = kSearch;
  // Before the last round, every second strength with the best set of outliers is enough.
  options.search.sets_given = last ? 2 : 1;
  options.search.strength_step = last ? 1 : 2;
  if (const auto found = found_before(a); found.size() > 1) options.hypotheses.push_back(found);
  if (a.system.e.size() > kManyRows) {
    options.kernels = {kKernelOfMany};
    options.discrepancies = last;
    options.search.sets_given = 1;
    options.search.strength_step = 2;
  }
  return options;
}

bool BeltRules::refit(Analysis& a) const {
  if (auto given = fit_as_decided(belts_, a)) {
    // A place without any counting reading stays where it was.
    belts_.frame = std::move(given->frame);
    a.known = std::move(given->causes);
  }
  belts_.sigma_mm *= std::sqrt(a.estimate.noise_square);
  return true;
}

std::optional<RegressorSystem> BeltRules::tried_with_noise(const Analysis& a) const {
  const FrameState& frame = belts_.alone.state;
  RegressorSystem system =
      system_of(belts_.belts, frame, observations_of(belts_.belts, frame, belts_.sigma_mm),
                a.candidates.testable);
  if (a.taken_out.size() > 0) system.e -= a.taken_out;
  return system;
}

void BeltRules::restrain(bool detected, Analysis& a) const {
  // If noise alone would make a cause look as strong as the strongest, none is named, whatever a
  // pattern seems to leave for it.
  if (!detected) withdraw_names(a.comparison, a.decision);
  take_expected_back(a);
  // The noise of belts is not stated, so it cannot exceed a stated value.
  a.decision.nothing += a.decision.noise;
  a.decision.noise = 0.0;
  if (a.decision.verdict == Verdict::noise_larger_than_stated)
    a.decision.verdict = Verdict::nothing_found;
}

Counting decided_counting(const Analysis& a) {
  const Flags& rejected = marginalised_system(a).outliers;
  Counting counting(a.system.places.size());
  for (const auto u : each_index(counting)) {
    for (const Belt belt : kBelts) {
      counting[a.system.places[u].place][belt] = !rejected[4 * u + as_size(belt)];
    }
  }
  return counting;
}

std::optional<FitGivenCauses> fit_as_decided(const BeltsAnalysis& belts, const Analysis& a) {
  std::vector<SizedCause> causes;
  for (const auto k : each_index(a.estimate.regressors)) {
    const Regressor& d = a.system.regressor(a.estimate.regressors[k]);
    causes.push_back(d);
    causes.back().values.front() = size_at(d, a.estimate.coefficient(as_index(k)));
  }
  AnchorFit from = belts.frame;
  from.counting = decided_counting(a);
  return fit_given_causes(belts.belts, std::move(causes), from);
}

Analysis analysis_of_laws(const BeltsAnalysis& a) {
  Analysis own = a;
  const bool ordered = any_of(a.belts.points, &BeltPoint::order);
  own.system.discrepancies = &length_discrepancies_of_laws(ordered);
  return own;
}

tl::expected<BeltsAnalysis, BeltsFitFailure> analyse(const MeasuredBelts& belts,
                                                     const DiagnosisOptions& options) {
  BeltsAnalysis a;
  tell(options.progress, kFitting);
  auto before = fit_belts(belts);
  if (!before) return failed(before);
  a.before = *std::move(before);
  tell(options.progress, kComparingBelts);
  a.measured = belts;
  a.belts = without_distances(belts);
  const auto alone = belts::fit_anchors_robustly(a.belts);
  if (!alone) return failed(BeltsFitFailure::Reason::no_frame, "no four anchors fit these lengths");
  a.alone = a.frame = *alone;
  a.sigma_mm = kUsualSpreadMm;
  a.options = options;
  a.candidates = candidates(a.belts);
  const BeltRules rules(a);
  if (const auto done = compare_in_rounds(rules, a); !done)
    return failed(BeltsFitFailure::Reason::no_frame, done.error().sentence());
  a.averaged = averaged_anchors(a.frame.state.anchors, a);
  decide_by(rules, true, a);
  return a;
}

}  // namespace chaintrue::grid::diagnosis
