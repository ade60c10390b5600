// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/analysis.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "grid/diagnosis/link_priors.hpp"
#include "grid/diagnosis/outlier_search.hpp"
#include "grid/diagnosis/relinearise.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr int kCalibrations = 8;
constexpr double kSettled_mm = 1e-4;

DiagnosisFailure unreachable(const Session& session, const model::VisitFailure& failure) {
  const SessionPoint& point = session.points[failure.index];
  return {DiagnosisFailure::Reason::point_unreachable,
          fmt::format("{} {} at ({:.1f}, {:.1f}) mm: {}",
                      session.distances ? "hole" : "point",
                      session.distances ? session.distances->set().holes[failure.index].name
                                        : fmt::format("{}", point.index + 1),
                      point.mark.x_mm,
                      point.mark.y_mm,
                      model::explain(failure.reason))};
}

DiagnosisFailure impossible(const Session& session, const model::MachineProblem& problem) {
  return {DiagnosisFailure::Reason::contradictory_settings,
          fmt::format("no machine near the stated one fits these {}: calibrating leads to {} = "
                      "{}. Check the feed, the attachment and the motors' positions, and that the "
                      "{} are those of this machine",
                      session.distances ? "distances" : "points",
                      problem.parameter,
                      problem.value,
                      session.distances ? "distances" : "lengths")};
}

/// Settings moved to where the points put them, no effect at work.
tl::expected<State, DiagnosisFailure> calibrate(const Session& session, const Steps& steps) {
  State state = stated_state(session);
  Steps projected = steps;
  projected.project_settings = true;
  const std::vector<bool> none(session.units(), false);
  for (int pass = 0; pass < kCalibrations; ++pass) {
    auto system = linearise(session, state, steps);
    if (!system) return tl::unexpected(unreachable(session, system.error()));
    system->g.resize(session.rows(), 0);
    const auto outliers = outlier_sets(session, *system, none, {{}}, projected).front();
    const MarginalisedSystem marginalised = marginalise(*system, outliers, projected);
    const Eigen::VectorXd change = estimate(session, *system, marginalised, {}, -1).setting_change;
    state = with_settings(session, state, system->setting + change);
    const auto problems = model::problems_of(state.machine);
    if (!problems.empty()) return tl::unexpected(impossible(session, problems.front()));
    const auto settings = static_cast<Eigen::Index>(session.settings.size());
    if (change.head(settings).cwiseAbs().maxCoeff() < kSettled_mm) break;
  }
  return state;
}

/// Strength below which no point plan names a cause: what cannot get there is left out of the
/// comparison, where it would only take probability from the others.
constexpr double kLeastReach = 4.0;

/// Takes effects out that could not show at any size that they may have.
void drop_invisible(const MarginalisedSystem& marginalised, Analysis& a) {
  const auto reach = [&](const CauseId& cause) {
    double most = 0.0;
    for (std::size_t k = 0; k < a.system.regressors.size(); ++k) {
      const Regressor& d = a.system.regressors[k];
      if (!(d.cause == cause)) continue;
      const double size = std::max(std::abs(d.lowest), std::abs(d.highest));
      most = std::max(most, size * marginalised.g.col(static_cast<Eigen::Index>(k)).norm());
    }
    return most;
  };
  std::vector<CauseId> visible;
  for (const CauseId& cause : a.candidates.testable) {
    if (reach(cause) >= kLeastReach) {
      visible.push_back(cause);
    } else {
      a.candidates.not_testable.push_back(
          {cause, "at any size that it may have, calibrating the settings would hide it"});
    }
  }
  const auto is_visible = [&](const Regressor& d) {
    return std::find(visible.begin(), visible.end(), d.cause) != visible.end();
  };
  std::vector<Eigen::Index> kept;
  std::vector<Regressor> regressors;
  for (std::size_t k = 0; k < a.system.regressors.size(); ++k) {
    if (!is_visible(a.system.regressors[k])) continue;
    kept.push_back(static_cast<Eigen::Index>(k));
    regressors.push_back(a.system.regressors[k]);
  }
  a.system.g = a.system.g(Eigen::all, kept).eval();
  a.system.regressors = std::move(regressors);
  a.candidates.testable = std::move(visible);
}

/// What is fitted is the member that gives its class the name: settings and sizes belong together.
void speak_of_leaders(const LinearisedSystem& system,
                      const ModelComparison& comparison,
                      Decision& decision) {
  for (int& k : decision.regressors) {
    const CauseId own = system.regressors[static_cast<std::size_t>(k)].cause;
    for (const CauseClass& members : decision.classes) {
      if (members.front() == own ||
          std::find(members.begin(), members.end(), own) == members.end()) {
        continue;
      }
      const auto alone = std::find_if(
          comparison.models.begin(), comparison.models.end(), [&](const CandidateModel& model) {
            return model.regressors.size() == 1 &&
                   system.regressors[static_cast<std::size_t>(model.regressors.front())].cause ==
                       members.front();
          });
      if (alone != comparison.models.end()) k = alone->regressors.front();
    }
  }
  std::sort(decision.regressors.begin(), decision.regressors.end());
}

}  // namespace

/// Share of what noise does not explain that causes named beside a model discrepancy must explain.
constexpr double kExplained = 0.93;
/// From this probability of a discrepancy on; below it what noise leaves would decide.
constexpr double kDiscrepancyLikely = 0.5;

Decision decide_beside_discrepancy(const Session& session,
                                   const LinearisedSystem& system,
                                   const ModelComparison& comparison,
                                   const std::vector<bool>& excluded,
                                   bool seen) {
  Decision decision = decide(system, comparison, excluded, seen);
  speak_of_leaders(system, comparison, decision);
  if (decision.listed.empty() || decision.discrepancy <= kDiscrepancyLikely ||
      decision.best_discrepancy < 0) {
    return decision;
  }
  // A discrepancy that nobody knows looks somewhat like this cause or that: what is named must
  // explain nearly all that noise does not.
  const MarginalisedSystem& marginalised = comparison.marginalised_systems[decision.marginalised];
  const auto unexplained = [&](const std::vector<int>& regressors) {
    const Estimate fitted = estimate(session, system, marginalised, regressors, -1);
    const Eigen::VectorXd left = left_of_machine(system, fitted, fitted.left);
    return square_in_noise(system, marginalised.kept, left) -
           static_cast<double>(marginalised.kept.size());
  };
  const double before = unexplained({});
  const double after = unexplained(decision.regressors);
  if (after <= (1.0 - kExplained) * before) return decision;
  return decide(system, comparison, excluded, false);
}

namespace {

void compare_and_decide(const Session& session,
                        const ComparisonOptions& options,
                        bool seen,
                        Analysis& a) {
  const std::vector<bool> none(session.units(), false);
  a.comparison = compare_models(session, a.system, none, options);
  a.decision = decide_beside_discrepancy(session, a.system, a.comparison, none, seen);
  a.estimate = estimate(session,
                        a.system,
                        a.comparison.marginalised_systems[a.decision.marginalised],
                        a.decision.regressors,
                        a.decision.discrepancy_left ? a.decision.best_discrepancy : -1);
}

void test_significance(const Session& session, const DiagnosisOptions& options, Analysis& a) {
  const MarginalisedSystem& marginalised =
      a.comparison.marginalised_systems[a.comparison.best().marginalised];
  const SingleScore score(
      a.system, marginalised, options.steps.anchor_noise ? session.noise_dof : 1e-3);
  // Enough draws for a family-wise 1 in 100; fewer where one draw is long.
  const int draws = session.units() > 150 ? 2000 : 4000;
  a.null = draw_null(score, marginalised.e.size(), draws, options.seed);
  a.score = score.by_cause(marginalised.e).maxCoeff();
  a.family_wise_p = a.null.p_value(a.score);
}

}  // namespace

tl::expected<Analysis, DiagnosisFailure> analyse(const Session& session,
                                                 const DiagnosisOptions& options) {
  Analysis a;
  auto state = calibrate(session, options.steps);
  if (!state) return tl::unexpected(state.error());
  a.state = std::move(*state);
  a.candidates = candidates(session);
  const ComparisonOptions comparison{options.steps, true, options.told};
  constexpr int kPasses = 2;
  std::vector<Refinement> known;
  for (int pass = 0; pass < kPasses; ++pass) {
    auto system = linearise(session, a.state, options.steps);
    if (!system) return tl::unexpected(unreachable(session, system.error()));
    a.system = std::move(*system);
    add_regressors(session, a.state, a.candidates.testable, known, a.system);
    const std::vector<bool> none(session.units(), false);
    const MarginalisedSystem marginalised = marginalise(a.system, none, options.steps);
    share_out_links(marginalised, a.system);
    if (pass == 0) drop_invisible(marginalised, a);
    compare_and_decide(session, comparison, true, a);
    if (pass + 1 == kPasses || a.decision.regressors.empty()) break;
    const Decision& decision = a.decision;
    const Leaders leaders{decision.regressors,
                          decision.discrepancy_left ? decision.best_discrepancy : -1};
    Relinearised relinearised =
        relinearise(session,
                    a.state,
                    a.system,
                    a.comparison.marginalised_systems[decision.marginalised],
                    leaders,
                    options.steps);
    known = std::move(relinearised.refinements);
    a.state = std::move(relinearised.state);
  }
  test_significance(session, options, a);
  if (a.family_wise_p >= kFalseAlarm && !options.told) {
    const std::vector<bool> none(session.units(), false);
    a.decision = decide_beside_discrepancy(session, a.system, a.comparison, none, false);
    a.estimate = estimate(session,
                          a.system,
                          a.comparison.marginalised_systems[a.decision.marginalised],
                          a.decision.regressors,
                          a.decision.discrepancy_left ? a.decision.best_discrepancy : -1);
  }
  return a;
}

}  // namespace chaintrue::grid::diagnosis
