// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/next_measurements.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "grid/diagnosis/leading.hpp"
#include "grid/diagnosis/next_candidates.hpp"
#include "grid/diagnosis/normal.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr std::size_t kMostAlternatives = 6;
constexpr double kLeastProbability = 0.01;
constexpr double kEnough = 0.97;
constexpr double kPays = 0.002;  // a measurement that helps less is not worth the way

struct Alternative {
  std::vector<int> regressors;
  double probability = 0.0;
  Eigen::VectorXd mean;    ///< of all candidate rows
  Eigen::MatrixXd spread;  ///< rows x unknowns: a square root of the covariance but for the noise
};

/// The sets of causes, as many as the verdict speaks of, that the comparison leaves; each with its
/// best places. Members of one class count as one.
std::vector<Alternative> leading(const Analysis& a) {
  const auto class_of = [&](const CauseId& cause) {
    for (std::size_t k = 0; k < a.decision.classes.size(); ++k) {
      const CauseClass& members = a.decision.classes[k];
      if (std::find(members.begin(), members.end(), cause) != members.end()) return k;
    }
    return a.decision.classes.size();
  };
  std::map<std::vector<std::size_t>, Alternative> groups;
  const std::size_t together = std::max<std::size_t>(a.decision.regressors.size(), 1);
  for (const CandidateModel& model : a.comparison.models) {
    if (model.regressors.size() != together) continue;
    std::vector<std::size_t> key;
    for (const int k : model.regressors) {
      key.push_back(class_of(a.system.regressors[static_cast<std::size_t>(k)].cause));
    }
    std::sort(key.begin(), key.end());
    Alternative& one = groups[key];
    if (one.probability == 0.0) one.regressors = model.regressors;
    one.probability += a.comparison.probability(model);
  }
  std::vector<Alternative> result;
  double all = 0.0;
  for (const auto& [key, one] : groups) all += one.probability;
  for (auto& [key, one] : groups) {
    if (one.probability >= kLeastProbability * all) result.push_back(std::move(one));
  }
  std::stable_sort(result.begin(), result.end(), [](const Alternative& x, const Alternative& y) {
    return x.probability > y.probability;
  });
  if (result.size() > kMostAlternatives) result.resize(kMostAlternatives);
  double sum = 0.0;
  for (const Alternative& h : result) sum += h.probability;
  for (Alternative& h : result) h.probability /= sum;
  return result;
}

/// The reading that tells members of one class apart which no points can: a chain's links.
void add_link_reading(const Analysis& a, std::vector<NextMeasurement>& list) {
  if (a.decision.listed.empty() || list.size() >= kMostNextMeasurements) return;
  const CauseClass& members = a.decision.classes[a.decision.listed.front()];
  const bool pitch = std::any_of(members.begin(), members.end(), [](const CauseId& c) {
    return c.effect->elongation != nullptr;
  });
  const auto is_pitch = [](const auto& x) { return x.what == "link_pitch_mm"; };
  if (members.size() < 2 || !pitch || std::any_of(list.begin(), list.end(), is_pitch) ||
      std::any_of(a.session.readings().begin(), a.session.readings().end(), is_pitch)) {
    return;
  }
  NextMeasurement reading{
      MeasurementKind::reading, "link_pitch_mm", "left", std::nullopt, kLinkPitchSigmaMm};
  for (const ClassProbability& one : a.decision.marginal) {
    if (one.index == a.decision.listed.front()) reading.raises_probability_to = one.probability;
  }
  if (!list.empty()) reading.raises_probability_to = list.back().raises_probability_to;
  list.push_back(std::move(reading));
}

/// What a hypothesis expects of every candidate.
void predict(const Analysis& a,
             const Session& next,
             const LinearisedSystem& system,
             Alternative& h) {
  const Estimate fitted = estimate_of(a, h.regressors);
  // Holes that are not cut yet have columns of their own, after all others.
  const Eigen::Index settings = fitted.setting_change.size();
  const Eigen::Index to_come = system.by_setting.cols() - settings;
  h.mean = system.by_setting.leftCols(settings) * fitted.setting_change;
  const auto free = static_cast<Eigen::Index>(fitted.free.size());
  Eigen::MatrixXd design(system.by_setting.rows(), settings + free);
  design.leftCols(settings) = system.by_setting.leftCols(settings);
  Eigen::Index column = settings;
  for (std::size_t k = 0; k < fitted.regressors.size(); ++k) {
    const Regressor& d = a.system.regressors[static_cast<std::size_t>(fitted.regressors[k])];
    const auto g = signature(next, a.state, system, d.cause, d.values);
    const Eigen::VectorXd column_of =
        g ? *g : Eigen::VectorXd(Eigen::VectorXd::Zero(system.by_setting.rows()));
    h.mean += column_of * fitted.coefficient(static_cast<Eigen::Index>(k));
    if (std::find(fitted.free.begin(), fitted.free.end(), k) != fitted.free.end()) {
      design.col(column++) = column_of;
    }
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(fitted.covariance);
  h.spread.resize(design.rows(), design.cols() + to_come);
  h.spread.leftCols(design.cols()) = design * Eigen::MatrixXd(llt.matrixL());
  h.spread.rightCols(to_come) =
      system.by_setting.rightCols(to_come) * system.sigma.tail(to_come).asDiagonal();
}

/// D over these rows, for two alternatives.
double distance(const Alternative& k, const Alternative& l, const std::vector<Eigen::Index>& rows) {
  const Eigen::VectorXd difference = k.mean(rows) - l.mean(rows);
  const Eigen::MatrixXd of_k = k.spread(rows, Eigen::all);
  const Eigen::MatrixXd of_l = l.spread(rows, Eigen::all);
  Eigen::MatrixXd covariance = 0.5 * (of_k * of_k.transpose() + of_l * of_l.transpose());
  covariance.diagonal().array() += 1.0;
  return difference.dot(covariance.llt().solve(difference));
}

/// Bound on confusion, and the probability that the right one is named alone.
struct Outlook {
  double confusion = 0.0;
  double named_alone = 0.0;
};

Outlook outlook(const std::vector<Alternative>& alternatives,
                const std::vector<Eigen::Index>& rows) {
  Outlook result;
  const double odds = std::log(kNamedAlone / (1.0 - kNamedAlone));
  const auto count = alternatives.size();
  std::vector<std::vector<double>> d(count, std::vector<double>(count, 0.0));
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t l = 0; l < k; ++l) {
      d[k][l] = d[l][k] = rows.empty() ? 0.0 : distance(alternatives[k], alternatives[l], rows);
      result.confusion += std::sqrt(alternatives[k].probability * alternatives[l].probability) *
                          std::exp(-d[k][l] / 8.0);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    double p = 1.0;
    for (std::size_t l = 0; l < count; ++l) {
      if (l == k) continue;
      const double ahead = 0.5 * d[k][l] +
                           std::log(alternatives[k].probability / alternatives[l].probability) -
                           odds;
      p *= d[k][l] > 1e-9 ? 1.0 - normal_upper(ahead / std::sqrt(d[k][l]))
                          : (ahead > 0.0 ? 1.0 : 0.0);
    }
    result.named_alone += alternatives[k].probability * p;
  }
  return result;
}

}  // namespace

std::vector<NextMeasurement> next_measurements(const Analysis& a) {
  if (a.decision.listed.empty()) return {};
  std::vector<NextMeasurement> result;
  std::vector<Alternative> alternatives = leading(a);
  NextCandidates next = next_candidates(a);
  const auto system = linearise(next.session, a.state, {});
  if (!system) return {};
  for (Alternative& h : alternatives) predict(a, next.session, *system, h);
  std::vector<Candidate>& options = next.all;
  std::vector<Eigen::Index> chosen;
  Outlook now = outlook(alternatives, chosen);
  double reached = a.decision.verdict == Verdict::named ? kEnough : now.named_alone;
  while (result.size() < kMostNextMeasurements && reached < kEnough) {
    std::size_t best = options.size();
    Outlook then = now;
    for (std::size_t c = 0; c < options.size(); ++c) {
      if (options[c].times == 0) continue;
      std::vector<Eigen::Index> more = chosen;
      more.insert(more.end(), options[c].rows.begin(), options[c].rows.end());
      const Outlook tried = outlook(alternatives, more);
      if (tried.confusion < then.confusion) {
        then = tried;
        best = c;
      }
    }
    if (best == options.size() || now.confusion - then.confusion < kPays * now.confusion) break;
    options[best].times -= 1;
    chosen.insert(chosen.end(), options[best].rows.begin(), options[best].rows.end());
    // The Gaussian approximation may dip where the first points only raise doubts; more data never
    // make the right name less likely in the mean.
    reached = std::max(reached, then.named_alone);
    result.push_back(options[best].measurement);
    result.back().raises_probability_to = reached;
    now = then;
  }
  add_link_reading(a, result);
  return result;
}

}  // namespace chaintrue::grid::diagnosis
