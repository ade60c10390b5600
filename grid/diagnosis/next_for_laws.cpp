// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "grid/containers.hpp"
#include "grid/diagnosis/law_model.hpp"
#include "grid/diagnosis/next_measurements.hpp"
#include "grid/diagnosis/regressors.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// What may be measured, as rows.
struct Next {
  const ObservationSet& session;
  const RegressorSystem& system;
};

/// What the causes of a context, and a law's amplitudes with them, make of the rows to come.
Eigen::MatrixXd columns_of(const Analysis& a,
                           const Next& next,
                           const std::vector<int>& regressors,
                           const Eigen::MatrixXd& law) {
  const auto causes = std::ssize(regressors);
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(next.system.e.size(), causes + law.cols());
  for (Eigen::Index k = 0; k < causes; ++k) {
    const Regressor& own = a.system.regressor(regressors[as_size(k)]);
    if (const auto g = signature(next.session, a.state, next.system, own.cause, own.values))
      columns.col(k) = *g;
  }
  columns.rightCols(law.cols()) = law;
  return columns;
}

/// `law` null: none.
Alternative expected_with(const Analysis& a,
                          const Next& next,
                          const LawEvidence& evidence,
                          const WeighedLaw* law) {
  Eigen::MatrixXd there(next.system.e.size(), 0);
  if (law != nullptr) there = LawColumns(next.system).of(evidence.curves[law->curve], law->at);
  const std::vector<int>& regressors =
      evidence.sets[law != nullptr ? law->set : evidence.without_set];
  LawModel::Expected expected =
      model_with(a, evidence, law).expected_of(next.system, columns_of(a, next, regressors, there));
  Alternative one;
  one.mean = std::move(expected.mean);
  one.spread = std::move(expected.spread);
  return one;
}

}  // namespace

std::vector<NextMeasurement> next_for_laws(const Analysis& a, const LawsFound& found) {
  if (found.laws.empty() || found.laws.front().probability >= kEnough) return {};
  NextCandidates candidates = next_candidates(a);
  const auto system = linearise(candidates.session, a.state);
  if (!system) return {};
  const Next next{candidates.session, *system};
  std::vector<Alternative> alternatives;
  double none = 1.0;
  for (std::size_t k = 0; k < found.laws.size(); ++k) {
    const LawEvidence& evidence = found.evidence[found.heaviest[k].evidence];
    alternatives.push_back(expected_with(a, next, evidence, &evidence.laws[found.heaviest[k].law]));
    alternatives.back().group = k;
    alternatives.back().probability = found.laws[k].probability;
    none -= found.laws[k].probability;
  }
  // What parts of the bed make of the odds may leave next to nothing to the rest.
  constexpr double kLeastOfNone = 0.01;
  alternatives.push_back(
      expected_with(a, next, found.evidence[found.heaviest.front().evidence], nullptr));
  alternatives.back().group = found.laws.size();
  alternatives.back().probability = std::max(none, kLeastOfNone);
  double all = 0.0;
  for (const Alternative& one : alternatives) all += one.probability;
  for (Alternative& one : alternatives) one.probability /= all;
  return most_telling(alternatives, std::move(candidates.all), false);
}

}  // namespace chaintrue::grid::diagnosis
