// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/analysis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/diagnosis/model_comparison.hpp"
#include "grid/failed.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// Prior of numbers of links: one is usual.
double log_share_of_links(double links) { return std::log(0.25) * (std::abs(links) - 1.0); }

/// In logarithms: for readings much better than usual every density underflows.
double log_strength_density(double signal_to_noise) {
  double sum = kMinusInfinity;
  for (const auto& [sigma, share] : kStrengthPriors) {
    sum = log_sum(sum,
                  std::log(share) - 0.5 * std::pow(signal_to_noise / sigma, 2) - std::log(sigma));
  }
  return sum;
}

/// Length of every regressor's column with the settings integrated out, no point set aside.
VectorXd reduced_lengths(const RegressorSystem& system) {
  return squared_lengths(system, marginalise(system, nothing_rejected(system))).cwiseSqrt();
}

/// Divides a cause's prior among its visits and numbers of links, and sets the odds of slips at one
/// visit. A whole number has no free size to carry the prior of a cause's strength, so the visits
/// carry it: density of the strength at each, as for any other cause.
void share_out_links(RegressorSystem& system) {
  const VectorXd lengths = reduced_lengths(system);
  const auto log_weight = [&](std::size_t k) {
    return log_share_of_links(system.regressors[k].values.front()) +
           log_strength_density(lengths(as_index(k)));
  };
  std::map<CauseId, double> log_all;
  for (const auto k : each_index(system.regressors)) {
    if (!system.regressors[k].fixed) continue;
    double& sum = log_all.try_emplace(system.regressors[k].cause, kMinusInfinity).first->second;
    sum = log_sum(sum, log_weight(k));
  }
  for (const auto k : each_index(system.regressors)) {
    Regressor& d = system.regressors[k];
    if (!d.fixed) continue;
    d.log_prior =
        log_weight(k) - log_all.at(d.cause) - std::log(as_double(d.cause.effect->sides.size()));
    if (d.slip) d.log_prior += std::log(kSlipOddsOfVisit * d.visits);
  }
}

constexpr int kCalibrations = 8;
constexpr double kConvergedMm = 1e-4;

DiagnosisFailure unreachable(const ObservationSet& session,
                             const observation::Unreachable& failure) {
  const NumberedPlace& place = session.places[failure.place];
  const ObservationPart& part = session.parts[place.part];
  return {DiagnosisFailure::Reason::point_unreachable,
          fmt::format("{} {} at ({:.1f}, {:.1f}) mm: {}", part.observation->kind().place,
                      part.observation->places()[failure.place - part.first_place].name,
                      place.mark.x_mm, place.mark.y_mm, failure.sentence())};
}

DiagnosisFailure impossible(const ObservationSet& session, std::string_view why) {
  const std::string_view units = session.units_word();
  return {
      DiagnosisFailure::Reason::contradictory_settings,
      fmt::format("no machine near the one in your file fits these {}: calibrating leads to "
                  "none ({}). Check the feed, the attachment and the motors' positions, and that "
                  "the {} are those of this machine",
                  units, why, units == "points" ? "lengths" : units)};
}

/// The largest of the settings' changes at the tool; a turn of the sheet counts at its edge.
double move_mm(const ObservationSet& session, const VectorXd& change) {
  const double to_edge_mm = 0.5 * session.stated.bed.width_mm;
  double most = 0.0;
  for (const Index k : each_below(session.setting_columns())) {
    const bool turn =
        session.is_of_chains() && session.settings[as_size(k)] == Setting::sheet_rotation_rad;
    most = std::max(most, (turn ? to_edge_mm : 1.0) * std::abs(change(k)));
  }
  return most;
}

/// Settings fitted to the readings, without effects.
tl::expected<void, DiagnosisFailure> calibrate(Analysis& a) {
  const ObservationSet& session = a.session;
  State state = stated_state(session);
  a.converged = false;
  for (int pass = 0; pass < kCalibrations && !a.converged; ++pass) {
    auto system = linearise(session, state);
    if (!system) return tl::unexpected(unreachable(session, system.error()));
    const auto outliers = outlier_sets(*system, nothing_rejected(*system), {{}}).front();
    const MarginalisedSystem marginalised = marginalise(*system, outliers);
    const VectorXd change = estimate(*system, marginalised, {}, -1).setting_change;
    auto moved = moved_to(session, std::move(state), system->setting + change);
    if (!moved) return tl::unexpected(impossible(session, moved.error()));
    state = *std::move(moved);
    a.converged = move_mm(session, change) < kConvergedMm;
  }
  a.state = std::move(state);
  return {};
}

/// Fits the named member of each class, so that settings and sizes are consistent.
void speak_of_leaders(const RegressorSystem& system, const ModelComparison& comparison,
                      Decision& decision) {
  for (int& k : decision.regressors) {
    const CauseId own = system.regressor(k).cause;
    for (const CauseClass& members : decision.classes) {
      if (members.front() == own || !contains(members, own)) {
        continue;
      }
      auto* alone = find_where(comparison.models, [&](const CandidateModel& model) {
        return model.regressors.size() == 1 &&
               system.regressor(model.regressors.front()).cause == members.front();
      });
      if (alone != nullptr) k = alone->regressors.front();
    }
  }
  sort(decision.regressors);
}

/// Removes causes that could not show, with this reason.
void drop_hidden(std::string_view reason, Analysis& a) {
  const VectorXd lengths = reduced_lengths(a.system);
  std::map<CauseId, double> reach;
  for (const auto k : each_index(a.system.regressors)) {
    const Regressor& d = a.system.regressors[k];
    const double size = std::max(std::abs(d.lowest), std::abs(d.highest));
    double& most = reach[d.cause];
    most = std::max(most, size * lengths(as_index(k)));
  }
  const auto shows = [&](const CauseId& cause) { return reach[cause] >= kLeastReach; };
  for (const CauseId& cause : a.candidates.testable) {
    if (!shows(cause)) a.candidates.not_testable.push_back({cause, std::string(reason)});
  }
  std::erase_if(a.candidates.testable, std::not_fn(shows));
  ColumnSet kept;
  for (const auto k : each_index(a.system.regressors)) {
    if (shows(a.system.regressors[k].cause)) kept.push_back(as_index(k));
  }
  a.system.g = a.system.g.subset(kept);
  std::erase_if(a.system.regressors, [&](const Regressor& d) { return !shows(d.cause); });
}

void test_significance(const AnalysisRules& rules, Analysis& a) {
  const auto own = rules.tried_with_noise(a);
  const RegressorSystem& causes = own ? *own : a.system;
  const MarginalisedSystem marginalised = marginalise(causes, a.comparison.best_system().outliers);
  // Given the length of the residuals, nothing else is known about the noise.
  constexpr double kNothingStated = 1e-3;
  const SingleScore score(causes, marginalised,
                          rules.noise == NoiseSize::stated ? causes.noise_dof : kNothingStated);
  // Enough draws for a family-wise 1 in 100, and in 300; fewer where one draw is long.
  constexpr std::size_t kManyUnits = 150;
  const int draws = causes.units.size() > kManyUnits ? 2000 : 4000;
  a.null = draw_null(score, marginalised, rules.noise, draws, a.options.seed);
  a.score = score.largest(marginalised.e)(0);
  // C. Bonferroni's bound.
  a.family_wise_p = std::min(1.0, a.options.orders_tried * a.null.p_value(a.score));
}

/// The settings calibrated before, and relinearised about what is found.
class CalibratedRules final : public AnalysisRules {
 public:
  tl::expected<void, DiagnosisFailure> linearise(Analysis& a) const override {
    auto system = diagnosis::linearise(a.session, a.state);
    if (!system) return tl::unexpected(unreachable(a.session, system.error()));
    a.system = std::move(*system);
    add_regressors(a.session, a.state, a.candidates.testable, a.known, a.system);
    share_out_links(a.system);
    return {};
  }
  ComparisonOptions compared(const Analysis& a, bool /*last*/) const override {
    ComparisonOptions options;
    // A smooth pattern is one of chain lengths over the bed.
    options.discrepancies = a.session.is_of_chains();
    if (!a.comparison.models.empty()) options.kernels = best_kernels(a.comparison);
    return options;
  }
  bool refit(Analysis& a) const override {
    if (a.decision.regressors.empty()) return false;
    relinearise(a);
    return true;
  }
};

}  // namespace

const AnalysisRules& calibrated_rules() {
  static const CalibratedRules rules;
  return rules;
}

void estimate_decided(Analysis& a) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  a.noise = discrepancy_noise(a.system, marginalised,
                              a.decision.discrepancy_left ? a.decision.best_discrepancy : -1);
  a.estimate = estimate(a.system, marginalised, a.decision.regressors, a.noise);
}

void decide_by(const AnalysisRules& rules, bool detected, Analysis& a) {
  a.decision = decide(a.system, a.comparison, nothing_rejected(a.system), detected,
                      classes_of(a.system, a.comparison));
  speak_of_leaders(a.system, a.comparison, a.decision);
  rules.restrain(detected, a);
  estimate_decided(a);
}

tl::expected<void, DiagnosisFailure> compare_in_rounds(const AnalysisRules& rules, Analysis& a) {
  for (int round = 1; round <= rules.rounds; ++round) {
    const bool last = round == rules.rounds;
    a.system.g = {};  // the columns of the round before
    if (auto done = rules.linearise(a); !done) return done;
    if (round == 1) drop_hidden(rules.hidden, a);
    a.comparison = compare_models(a.system, nothing_rejected(a.system), rules.compared(a, last));
    if (last) break;
    decide_by(rules, true, a);
    if (!rules.refit(a)) break;
  }
  return {};
}

void judge(const AnalysisRules& rules, Analysis& a) {
  test_significance(rules, a);
  // An average has no weights that remain valid without some of the readings.
  a.sessions = session_posteriors(a.system, a.session.fewest_units, a.comparison);
  if (a.options.average_parts)
    a.parts = average_over_parts(a.system, a.session.fewest_units, a.comparison);
  decide_by(rules, a.family_wise_p < rules.false_alarm, a);
}

tl::expected<Analysis, DiagnosisFailure> analyse(ObservationSet session,
                                                 const DiagnosisOptions& options) {
  Analysis a;
  a.session = std::move(session);
  a.options = options;
  if (auto done = calibrate(a); !done) return failed(done);
  a.candidates = candidates(a.session);
  if (auto done = compare_in_rounds(calibrated_rules(), a); !done) return failed(done);
  judge(calibrated_rules(), a);
  return a;
}

Analysis analyse_without(Analysis a, const VectorXd& rows, const AnalysisRules& rules) {
  a.system.e -= rows;
  a.taken_out = rows;
  a.comparison = compare_models(a.system, nothing_rejected(a.system), rules.compared(a, true));
  judge(rules, a);
  return a;
}

const Regressor& regressor(const Analysis& a, int k) { return a.system.regressor(k); }

const MarginalisedSystem& marginalised_system(const Analysis& a) {
  return a.comparison.marginalised_systems[a.decision.marginalised];
}

int best_regressor(const Analysis& a, const CauseId& cause) {
  for (const int k : a.decision.regressors) {
    if (regressor(a, k).cause == cause) return k;
  }
  for (const CandidateModel& model : a.comparison.models) {
    if (model.regressors.size() != 1) continue;
    if (regressor(a, model.regressors.front()).cause == cause) return model.regressors.front();
  }
  for (const auto& [own, k] : best_regressors(a.system, marginalised_system(a))) {
    if (own == cause) return k;
  }
  return -1;
}

void reject_slips(const Analysis& a, Flags& outliers) {
  for (const int k : a.decision.regressors) {
    const Regressor& own = regressor(a, k);
    if (!own.slip) continue;
    for (const auto u : each_index(a.system.units)) {
      const SystemUnit& unit = a.system.units[u];
      if (!unit.reads_chains) continue;
      const SystemPlace& place = a.system.places[unit.places.front().place];
      if (place.ordered && place.order == static_cast<int>(own.values.back())) outliers[u] = true;
    }
  }
}

bool same_class(const Analysis& a, const CauseId& x, const CauseId& y) {
  const std::size_t home = a.decision.class_of(x);
  return x == y || (home < a.decision.classes.size() && home == a.decision.class_of(y));
}

Nearest nearest_other(const Analysis& a, int column) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const VectorXd own = reduced(marginalised, a.system.g.col(column));
  const VectorXd products = with_regressors(a.system, marginalised, own);
  const VectorXd squares = squared_lengths(a.system, marginalised);
  const auto excluded = [&](const CauseId& other) {
    if (same_class(a, other, regressor(a, column).cause)) return true;
    if (a.decision.verdict != Verdict::several_causes) return false;
    return any_of(a.decision.regressors,
                  [&](int k) { return same_class(a, other, regressor(a, k).cause); });
  };
  Nearest nearest;
  for (const auto k : each_index(a.system.regressors)) {
    const auto at = as_index(k);
    if (excluded(a.system.regressors[k].cause)) continue;
    const double collinearity = collinearity_of(products(at), own.norm() * std::sqrt(squares(at)));
    // Among columns that differ only by rounding the first wins, on any processor.
    constexpr double kRounding = 1e-9;
    if (collinearity > nearest.collinearity + kRounding) nearest = {as_int(k), collinearity};
  }
  return nearest;
}

Shown shown(const Analysis& a) {
  Shown result{a.decision.regressors, {}};
  if (result.best.empty() && !a.decision.marginal.empty()) {
    result.best = {
        best_regressor(a, a.decision.classes[a.decision.marginal.front().index].front())};
  }
  if (result.best.empty()) return result;
  int first = result.best.front();
  if (!a.decision.listed.empty()) {
    first = best_regressor(a, a.decision.classes[a.decision.listed.front()].front());
  }
  const Nearest other = nearest_other(a, first);
  if (other.column >= 0) result.rival = {other.column};
  return result;
}

Estimate estimate_with(const Analysis& a, RegressorSet regressors) {
  sort(regressors);
  return estimate(a.system, marginalised_system(a), regressors, a.noise);
}

Estimate estimate_of(const Analysis& a, const RegressorSet& regressors) {
  return estimate(a.system, marginalised_system(a), regressors, -1);
}

}  // namespace chaintrue::grid::diagnosis
