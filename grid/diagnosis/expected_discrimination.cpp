// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/expected_discrimination.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "grid/parallel.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kMostGroups = 6;
constexpr double kLeastProbability =
    0.01;  ///< for a group among all, and for a member in its group

/// A cause by its class and its position there.
using Member = std::pair<std::size_t, std::size_t>;

Member member_of(const Analysis& a, const CauseId& cause) {
  const std::size_t home = a.decision.class_of(cause);
  if (home == a.decision.classes.size()) return {home, 0};
  const CauseClass& members = a.decision.classes[home];
  return {home, as_size(std::find(members.begin(), members.end(), cause) - members.begin())};
}

struct Group {
  double probability = 0.0;
  std::map<std::vector<Member>, Alternative> members;
};

/// By the classes of the causes, and in each group by the causes. If nothing is named a pattern
/// forms a separate group.
std::map<std::pair<bool, Indices>, Group> groups_of(const Analysis& a) {
  std::map<std::pair<bool, Indices>, Group> groups;
  const std::size_t named = a.decision.regressors.size();
  for (const CandidateModel& model : a.comparison.models) {
    if (named > 0 ? model.regressors.size() != named : model.regressors.size() > 1) continue;
    auto causes =
        mapped(model.regressors, [&](int k) { return member_of(a, regressor(a, k).cause); });
    sort(causes);
    const bool pattern = named == 0 && model.discrepancy >= 0;
    Group& group = groups[{pattern, mapped(causes, &Member::first)}];
    Alternative& one = group.members[causes];
    if (one.probability == 0.0) {
      one.regressors = model.regressors;
      one.discrepancy = model.discrepancy;
    }
    one.probability += a.comparison.probability(model);
    group.probability += a.comparison.probability(model);
  }
  return groups;
}

/// Adds the discrepancy of the estimate to the prediction for the rows of `system` by kriging, with
/// K the covariance of future and measured rows, C that of the measured rows with their noise, and
/// X their design.
///   mean + K C^-1 (residual),  design - K C^-1 X,  and K** - K C^-1 K' of its own
/// C. Rasmussen and C. Williams, Gaussian Processes for Machine Learning (2006), equation 2.41.
/// \returns the last.
MatrixXd add_discrepancy(const Analysis& a, const RegressorSystem& system, const Estimate& fitted,
                         const LowRankNoise& covariance, ExpectedRows& expected) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  auto [own, k] = discrepancy_at(system, fitted.discrepancy, a.system, marginalised.kept);
  const MatrixXd x = unknowns_of(a.system, marginalised, fitted.free_regressors()).design;
  linear::add_product(expected.mean, 1.0, k, fitted.discrepancy_weights);
  linear::add_product(expected.by_unknown, -1.0, k, covariance.solve(x));
  linear::add_gram(own, -1.0, covariance.half_solve(MatrixXd(k.transpose())));
  return without_negligible(own);
}

/// An alternative's prediction for every candidate.
void predict(const Analysis& a, const RegressorSystem& system, const ColumnOf& column_of_cause,
             Alternative& h) {
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const auto noise = discrepancy_noise(a.system, marginalised, h.discrepancy);
  const Estimate fitted = estimate(a.system, marginalised, h.regressors, noise);
  ExpectedRows expected = expected_rows(a, fitted, system, column_of_cause);
  h.covariance.setZero(system.e.size(), system.e.size());
  if (noise.is_of_process())
    h.covariance = add_discrepancy(a, system, fitted, noise.covariance, expected);
  h.mean = std::move(expected.mean);
  // Holes not yet cut have their own columns, after all others.
  const Index to_come = system.by_setting.cols() - fitted.setting_change.size();
  linear::add_outer(
      h.covariance, 1.0,
      linear::product(expected.by_unknown, linear::Cholesky(fitted.covariance).lower()));
  linear::add_outer(
      h.covariance, 1.0,
      linear::scaled_columns(system.by_setting.rightCols(to_come), system.sigma.tail(to_come)));
}

/// D over these rows, for two alternatives.
double distance(const Alternative& k, const Alternative& l, const Rows& rows) {
  const VectorXd difference = k.mean(rows) - l.mean(rows);
  MatrixXd covariance = 0.5 * (k.covariance(rows, rows) + l.covariance(rows, rows));
  covariance.diagonal().array() += 1.0;
  return linear::Cholesky(std::move(covariance)).half_solve(difference).squaredNorm();
}

/// D between all alternatives.
MatrixXd distances(const std::vector<Alternative>& alternatives, const Rows& rows) {
  const auto count = std::ssize(alternatives);
  MatrixXd d = MatrixXd::Zero(count, count);
  if (rows.empty()) return d;
  for (const Index k : each_below(count)) {
    for (const Index l : each_below(k)) {
      d(k, l) = d(l, k) = distance(alternatives[as_size(k)], alternatives[as_size(l)], rows);
    }
  }
  return d;
}

}  // namespace

MatrixXd without_negligible(const MatrixXd& covariance) {
  constexpr double kNegligible = 1e-4;
  return linear::outer(linear::PivotedCholesky(covariance).root(kNegligible));
}

void normalise(std::vector<Alternative>& alternatives) {
  double sum = 0.0;
  for (const Alternative& one : alternatives) sum += one.probability;
  for (Alternative& one : alternatives) one.probability /= sum;
}

std::vector<Alternative> alternatives_of_best(const Analysis& a) {
  std::vector<Group> groups;
  double all = 0.0;
  for (auto& [key, group] : groups_of(a)) {
    all += group.probability;
    groups.push_back(std::move(group));
  }
  std::erase_if(groups, [&](const Group& g) { return g.probability < kLeastProbability * all; });
  stable_sort(groups, descending(&Group::probability));
  if (groups.size() > kMostGroups) groups.resize(kMostGroups);
  std::vector<Alternative> result;
  for (const auto number : each_index(groups)) {
    for (auto& [causes, one] : groups[number].members) {
      if (one.probability < kLeastProbability * groups[number].probability) continue;
      one.group = number;
      result.push_back(std::move(one));
    }
  }
  normalise(result);
  return result;
}

std::optional<std::vector<Alternative>> alternatives_about(const Analysis& a,
                                                           const ObservationSet& next) {
  const auto system = linearise(next, a.state);
  if (!system) return std::nullopt;
  return alternatives_about(
      a, *system, [&](const SizedCause& own) { return signature(next, a.state, *system, own); });
}

std::vector<Alternative> alternatives_about(const Analysis& a, const RegressorSystem& next,
                                            const ColumnOf& column) {
  std::vector<Alternative> alternatives = alternatives_of_best(a);
  for_each_index(alternatives.size(),
                 [&](std::size_t k) { predict(a, next, column, alternatives[k]); });
  return alternatives;
}

namespace {

/// Log odds against a group, about N(mean, variance).
struct Rival {
  double mean = 0.0;
  double variance = 0.0;
};

/// Probability that all rivals together leave it named. The effect of the strongest rival is summed
/// over its log odds; of the others, which the same readings refute, the likeliest to remain must
/// leave the rest.
double chance_of_all(const std::vector<Rival>& rivals) {
  const double odds = (1.0 - kNamedAlone) / kNamedAlone;
  const auto taken = [](const Rival& rival) {
    return rival.mean - 2.0 * std::sqrt(rival.variance);
  };
  const auto most = min_element(rivals, ascending(taken));
  constexpr double kWidest = 4.0;  // sigmas
  constexpr int kSteps = 32;
  double chance = 0.0;
  double all = 0.0;
  for (const int step : each_below(kSteps)) {
    const double z = kWidest * ((2.0 * step + 1.0) / kSteps - 1.0);
    const double density = std::exp(-0.5 * z * z);
    all += density;
    const double left = odds - std::exp(-(most->mean + z * std::sqrt(most->variance)));
    if (left <= 0.0) continue;
    double of_others = 1.0;
    for (auto rival = rivals.begin(); rival != rivals.end(); ++rival) {
      if (rival == most) continue;
      const double ahead = rival->mean + std::log(left);
      const double alone = rival->variance > 1e-9
                               ? 1.0 - normal_upper(ahead / std::sqrt(rival->variance))
                               : (ahead > 0.0 ? 1.0 : 0.0);
      of_others = std::min(of_others, alone);
    }
    chance += density * of_others;
  }
  return chance / all;
}

}  // namespace

ExpectedDiscrimination expected_discrimination(const std::vector<Alternative>& alternatives,
                                               const Rows& rows) {
  const MatrixXd d = distances(alternatives, rows);
  Index groups = 0;
  for (const Alternative& one : alternatives) groups = std::max(groups, as_index(one.group) + 1);
  VectorXd probability = VectorXd::Zero(groups);
  MatrixXd shared = MatrixXd::Zero(groups, groups);
  ExpectedDiscrimination result;
  for (const Index k : each_below(d.rows())) {
    const Alternative& own = alternatives[as_size(k)];
    const Index of = as_index(own.group);
    probability(of) += own.probability;
    // Of each group: log of the sum of p_l exp(-D_kl / 2), the largest term, and D of that member. Two of
    // these sums differ by the mean log odds of their groups.
    VectorXd weight = VectorXd::Constant(groups, kMinusInfinity);
    VectorXd largest = weight;
    VectorXd nearest(groups);
    for (const Index l : each_below(d.cols())) {
      const Alternative& other = alternatives[as_size(l)];
      const Index group = as_index(other.group);
      shared(of, group) += own.probability * other.probability * std::exp(-d(k, l) / 8.0);
      const double term = std::log(other.probability) - 0.5 * d(k, l);
      if (term > largest(group)) nearest(group) = d(k, l);
      largest(group) = std::max(largest(group), term);
      weight(group) = log_sum(weight(group), term);
    }
    std::vector<Rival> rivals;
    for (const Index group : each_below(groups)) {
      if (group != of) rivals.push_back({weight(of) - weight(group), nearest(group)});
    }
    result.named_alone += own.probability * (rivals.empty() ? 1.0 : chance_of_all(rivals));
  }
  for (const Index one : each_below(groups)) {
    for (const Index other : each_below(one))
      result.confusion += shared(one, other) / std::sqrt(probability(one) * probability(other));
  }
  return result;
}

}  // namespace chaintrue::grid::diagnosis
