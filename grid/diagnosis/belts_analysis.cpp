// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/belts_analysis.hpp"

#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/discrepancy.hpp"
#include "grid/diagnosis/regressors.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {

namespace {

/// What one belt's reading is off by before any is read: four owners' frames, 0.5 to 1 mm.
constexpr double kUsualSpreadMm = 0.6;
/// Chance of noise to make some cause look as strong, below which causes are spoken of: a tenth of what
/// chains allow, for what pulled belts are expected to do makes a name of little. It costs hardly
/// anything: of causes of strength 6 to 8, the weakest that are asked for, 48 of 55 are beyond it.
constexpr double kFalseAlarmOfBelts = 0.001;
/// Beside a pattern, how much likelier than beforehand the readings must make a cause that is named:
/// "positive" evidence (R. Kass and A. Raftery, J. Am. Stat. Assoc. 90 (1995), 777).
constexpr double kSpokenFor = 3.0;
/// Places in a part of the bed: anchors need four, and a check at each besides shows that one is wrong.
constexpr std::size_t kFewestPlaces = 8;
/// Linearised about nothing, about what was found, and about what that leaves.
constexpr int kCalibrationRounds = 3;

/// Regressors of a cause that are weighed, and what sets in at about one visit: an anchor that slips in
/// a way between those that are tried looks like a skip of another belt as well.
constexpr SearchLimits kSearch{.of_a_cause = 3, .one_event_visits = 4.0};
/// With more rows a pattern costs seconds: one kernel, at the end alone.
constexpr Eigen::Index kManyRows = 500;
constexpr std::size_t kKernelOfMany = 1;

/// Of the system the regressors at the values that were found before.
std::vector<int> found_before(const BeltsAnalysis& a) {
  std::vector<int> found;
  for (const BeltCause& own : a.state.causes) {
    for (std::size_t k = 0; k < a.analysis.system.regressors.size(); ++k) {
      const Regressor& d = a.analysis.system.regressors[k];
      if (d.cause == own.cause && d.values == own.values) {
        found.push_back(static_cast<int>(k));
        break;
      }
    }
  }
  sort(found);
  return found;
}

/// Noise of belts is not stated, so none is larger than that.
void leave_noise_open(Decision& decision) {
  decision.nothing += decision.noise;
  decision.noise = 0.0;
  if (decision.verdict == Verdict::noise_larger_than_stated)
    decision.verdict = Verdict::nothing_found;
}

/// By how much the readings make the odds of a cause given a pattern larger than they are beforehand;
/// infinity where the pattern alone is out of the question.
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

/// What is expected beforehand, and is not any likelier for the readings, is no finding: with a
/// pattern, where less than surely is enough for a name, it is the pattern that was found.
void take_expected_back(BeltsAnalysis& a) {
  Decision& decision = a.analysis.decision;
  if (decision.verdict != Verdict::named || !(decision.discrepancy > kDiscrepancyLikely)) return;
  if (decision.marginal.front().probability >= kNamedAlone) return;
  const CauseClass& named = decision.classes[decision.listed.front()];
  if (spoken_for(a.analysis, named) < kSpokenFor) withdraw_names(a.analysis.comparison, decision);
}

/// Decision, and the estimate of its causes: given the pattern that it holds, if any.
void decide(bool detected, BeltsAnalysis& a) {
  Analysis& own = a.analysis;
  decide_for_leaders(detected, own);
  // Where the strongest cause is no more than noise does by chance, none is named, whatever a pattern with
  // it seems to leave for it.
  if (!detected) withdraw_names(own.comparison, own.decision);
  take_expected_back(a);
  estimate_decided(own);
}

/// What a verdict needs beyond the comparison.
void weigh_for_a_verdict(BeltsAnalysis& a) {
  Analysis& own = a.analysis;
  RegressorSystem alone = system_of(a.belts, {a.alone, {}}, own.candidates.testable, a.sigma_mm);
  if (a.taken_out.size() > 0) alone.e -= a.taken_out;
  test_significance(alone, NoiseSize::unknown, own);
  if (!own.options.average_parts || own.options.given_cause) return;
  own.parts = average_over_parts(own.system, own.session.fewest_units, own.comparison);
}

void compare(bool last, AnalysisDepth depth, BeltsAnalysis& a) {
  Analysis& own = a.analysis;
  ComparisonOptions options{.given_cause = own.options.given_cause};
  options.search = kSearch;
  // Until the last every other strength with the best set of outliers says enough.
  options.search.sets_given = last ? 2 : 1;
  options.search.strength_step = last ? 1 : 2;
  if (const auto found = found_before(a); found.size() > 1) options.hypotheses.push_back(found);
  if (own.system.e.size() > kManyRows) {
    options.kernels = {kKernelOfMany};
    options.discrepancies = last;
    options.search.sets_given = 1;
    options.search.strength_step = 2;
  }
  own.comparison = compare_models(own.system, nothing_rejected(own.system), options);
  if (last) a.averaged = averaged_anchors(a.state, own.system, own.comparison);
  const bool for_a_verdict = last && depth == AnalysisDepth::verdict;
  if (for_a_verdict) weigh_for_a_verdict(a);
  decide(!for_a_verdict || own.family_wise_p < kFalseAlarmOfBelts, a);
}

/// Anchors, places and sizes as the decision has them. The state stays where that settles nowhere.
void move_state(BeltsAnalysis& a) {
  belts::AnchorFit from = a.state.frame;
  from.counting = decided_counting(a);
  auto given = fit_given_causes(a.belts, decided_causes(a.analysis), from);
  if (!given) return;
  // A place of which everything is set aside stays where it was.
  a.state = {std::move(given->frame), std::move(given->causes)};
}

}  // namespace

belts::Counting decided_counting(const BeltsAnalysis& a) {
  return counting_of(
      a.analysis.system,
      a.analysis.comparison.marginalised_systems[a.analysis.decision.marginalised].outliers);
}

Analysis analysis_of_laws(const BeltsAnalysis& a) {
  Analysis own = a.analysis;
  const bool ordered =
      any_of(a.belts.points, [](const BeltPoint& point) { return point.order.has_value(); });
  own.system.discrepancies = &length_discrepancies_of_laws(ordered);
  return own;
}

BeltsAnalysis analyse_without(BeltsAnalysis a, Eigen::VectorXd rows) {
  a.analysis.system.e -= rows;
  a.taken_out = std::move(rows);
  compare(true, AnalysisDepth::verdict, a);
  leave_noise_open(a.analysis.decision);
  return a;
}

std::vector<BeltCause> decided_causes(const Analysis& a) {
  std::vector<BeltCause> causes;
  for (std::size_t k = 0; k < a.estimate.regressors.size(); ++k) {
    const Regressor& d = a.system.regressor(a.estimate.regressors[k]);
    BeltCause own{d.cause, d.values};
    own.values.front() = size_at(d, a.estimate.coefficient(as_index(k)));
    causes.push_back(std::move(own));
  }
  return causes;
}

tl::expected<BeltsAnalysis, DiagnosisFailure> analyse(const MeasuredBelts& belts,
                                                      const DiagnosisOptions& options,
                                                      AnalysisDepth depth) {
  BeltsAnalysis a;
  a.belts = without_distances(belts);
  const auto alone = belts::fit_anchors_robustly(a.belts);
  if (!alone) {
    return tl::unexpected(DiagnosisFailure{DiagnosisFailure::Reason::contradictory_settings,
                                           "no four anchors make sense of these lengths"});
  }
  a.alone = *alone;
  a.state = {*alone, {}};
  a.sigma_mm = kUsualSpreadMm;
  Analysis& own = a.analysis;
  own.options = options;
  own.candidates = candidates(a.belts);
  own.system = system_of(a.belts, a.state, own.candidates.testable, a.sigma_mm);
  own.session.units.resize(own.system.units.size());
  own.session.fewest_units = kFewestPlaces;
  drop_hidden(marginalise(own.system, nothing_rejected(own.system)),
              "at any size that it may have, other anchors would hide it: measure at more places, "
              "spread over the sheet",
              own);
  for (int pass = 0; pass < kCalibrationRounds; ++pass) {
    compare(pass + 1 == kCalibrationRounds, depth, a);
    if (pass + 1 == kCalibrationRounds) break;
    move_state(a);
    a.sigma_mm *= std::sqrt(own.estimate.noise_square);
    own.system = system_of(a.belts, a.state, own.candidates.testable, a.sigma_mm);
  }
  leave_noise_open(own.decision);
  return a;
}

}  // namespace chaintrue::grid::diagnosis
