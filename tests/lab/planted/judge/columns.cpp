// SPDX-License-Identifier: GPL-3.0-or-later
#include "planted/judge/columns.hpp"

#include <stdexcept>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/link_priors.hpp"
#include "sealed/judge/trial.hpp"

namespace chaintrue::planted {
namespace {

using namespace grid::diagnosis;

RegressorSystem linearised(const ObservationSet& session, const State& state) {
  auto system = linearise(session, state, Steps{});
  if (!system) throw std::runtime_error(system.error().sentence());
  return std::move(*system);
}

/// Settings moved to where the readings put them.
State calibrated(const ObservationSet& session) {
  // Each step leaves a hundredth of the step before it, of settings that are centimetres off.
  constexpr int kSteps = 5;
  State state = grid::estimation::stated_state(session);
  for (int step = 0; step < kSteps; ++step) {
    RegressorSystem system = linearised(session, state);
    system.g = RegressorColumns(session.rows);
    const auto marginalised = marginalise(system, nothing_rejected(system), Steps{});
    const Eigen::VectorXd change = estimate(system, marginalised, {}, -1).setting_change;
    state = grid::estimation::with_settings(session, state, system.setting + change);
  }
  return state;
}

/// Those that could show at a size that they may have.
RegressorSystem with_visible(const RegressorSystem& all, const MarginalisedSystem& marginalised) {
  RegressorSystem system = all;
  system.regressors.clear();
  std::vector<Eigen::Index> kept;
  for (std::size_t k = 0; k < all.regressors.size(); ++k) {
    if (!is_observable(all, marginalised, all.regressors[k].cause)) continue;
    kept.push_back(static_cast<Eigen::Index>(k));
    system.regressors.push_back(all.regressors[k]);
  }
  system.g = all.g.subset(kept);
  return system;
}

}  // namespace

Prepared prepare(const grid::MeasuredGrid& grid) {
  const auto session = observations_of(grid::Measured(grid));
  if (!session) throw std::runtime_error(session.error().sentence());
  const State state = calibrated(*session);
  RegressorSystem system = linearised(*session, state);
  add_regressors(*session, state, candidates(*session).testable, {}, system);
  const auto all = marginalise(system, nothing_rejected(system), Steps{});
  share_out_links(all, system);
  Prepared prepared{with_visible(system, all), {}};
  prepared.marginalised = marginalise(prepared.system, nothing_rejected(prepared.system), Steps{});
  return prepared;
}

Regression regression_of(const Prepared& prepared) {
  const RegressorColumns& g = prepared.marginalised.g;
  Regression data;
  data.y = prepared.marginalised.e;
  data.taken = static_cast<int>(prepared.system.setting.size());
  // Multiples of a column are one column of another size.
  std::vector<bool> has(static_cast<std::size_t>(g.distinct().cols()), false);
  std::vector<Eigen::Index> columns;
  for (Eigen::Index k = 0; k < g.cols(); ++k) {
    const auto own = static_cast<std::size_t>(g.index(k));
    // Of a visit at which nothing was read but what the settings take.
    constexpr double kNothing = 1e-6;
    if (has[own] || g.col(k).norm() < kNothing) continue;
    has[own] = true;
    columns.push_back(k);
    data.causes.push_back(
        sealed::id_of(prepared.system.regressors[static_cast<std::size_t>(k)].cause));
  }
  data.columns.resize(g.rows(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    data.columns.col(static_cast<Eigen::Index>(k)) = g.col(columns[k]);
  }
  return data;
}

Scores scores_without_discrepancy(const Prepared& prepared) {
  ComparisonOptions options;
  options.discrepancies = false;
  const std::vector<bool> none = nothing_rejected(prepared.system);
  const ModelComparison comparison = compare_models(prepared.system, none, options);
  const Decision decision = decide(prepared.system, comparison, none, true);
  Scores scores;
  for (const ClassProbability& one : decision.marginal) {
    if (one.probability > 0.0) {
      scores[sealed::id_of(decision.classes[one.index].front())] = one.probability;
    }
  }
  return scores;
}

}  // namespace chaintrue::planted
