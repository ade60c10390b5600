// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/cause_parameters.hpp"
#include "grid/diagnosis/constants.hpp"
#include "interp/linear_algebra.hpp"
#include "grid/observation/drawn_measures.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using model::effects::EffectParameter;

constexpr double kQuantile95 = 1.645;  // one-sided 95 %
constexpr double kSettingOff = 3.0;    // sigmas: 1 in 370 for each setting

/// Length of a column before projection on the settings.
double raw_length(const Analysis& a, int column) {
  return length_in_noise(a.system, marginalised_system(a).kept, a.system.g.col(column));
}

double marginal(const Analysis& a, std::size_t index) {
  for (const ClassProbability& one : a.decision.marginal) {
    if (one.index == index) return one.probability;
  }
  return 0.0;
}

Cause describe(const Analysis& a, std::size_t index) {
  const CauseClass& members = a.decision.classes[index];
  Cause cause;
  cause.cause = members.front();
  cause.probability = marginal(a, index);
  // Other named causes stay in the model; rivals of a set are each fitted alone.
  std::vector<int> others;
  for (const int k : a.decision.regressors) {
    const CauseId& acting = regressor(a, k).cause;
    const bool several = a.decision.verdict == Verdict::several_causes;
    if (several && !contains(members, acting)) {
      others.push_back(k);
    }
  }
  for (const CauseId& member : members) {
    const int column = best_regressor(a, member);
    std::vector<int> set = others;
    set.push_back(column);
    const Estimate fitted = estimate_with(a, set);
    const Eigen::Index at = position_of(fitted, column);
    auto found = parameters_of(a, column, fitted);
    if (member == members.front()) {
      const double length = marginalised_system(a).g.col(column).norm();
      cause.signal_to_noise = std::abs(fitted.coefficient(at)) * length;
      cause.share_left = length / std::max(raw_length(a, column), 1e-12);
      cause.parameters = std::move(found);
      if (const Nearest other = nearest_other(a, column); other.column >= 0) {
        cause.rival = regressor(a, other.column).cause;
        cause.rival_collinearity = other.collinearity;
      }
    } else {
      cause.same_as.push_back({member, std::move(found)});
    }
  }
  cause.order_assumed =
      a.options.order_assumed && cause.cause.effect->needs == model::effects::DataNeed::order;
  return cause;
}

std::vector<CauseId> listed_causes(const Analysis& a) {
  std::vector<CauseId> result;
  for (const std::size_t index : a.decision.listed) {
    const CauseClass& members = a.decision.classes[index];
    append_all(result, members);
  }
  return result;
}

}  // namespace

std::vector<Cause> causes_found(const Analysis& a) {
  std::vector<Cause> result;
  for (const std::size_t index : a.decision.listed) {
    result.push_back(describe(a, index));
  }
  return result;
}

Hypothesis hypothesis_of(const CauseClass& members, double probability) {
  const CauseId& cause = members.front();
  return {std::string(cause.effect->id), std::string(model::effects::name(cause.side)), probability, members};
}

std::vector<Hypothesis> hypotheses(const Analysis& a) {
  std::vector<Hypothesis> result;
  for (const ClassProbability& one : a.decision.marginal) {
    result.push_back(hypothesis_of(a.decision.classes[one.index], one.probability));
  }
  result.push_back({"nothing", "", a.decision.nothing});
  result.push_back({"unknown", "", a.decision.discrepancy});
  result.push_back({"noise", "", a.decision.noise});
  result.push_back({"bad_points", "", a.decision.outliers});
  stable_sort(result, descending(&Hypothesis::probability));
  return result;
}

namespace {

/// A cause with a higher probability is not reported as absent.
constexpr double kMayAct = 0.05;

}  // namespace

double probability_of(const Analysis& a, const CauseId& cause) {
  for (const ClassProbability& one : a.decision.marginal) {
    const CauseClass& members = a.decision.classes[one.index];
    if (contains(members, cause)) return one.probability;
  }
  return 0.0;
}

std::vector<Bound> bounds(const Analysis& a, std::vector<NotTestable>& not_testable) {
  const std::vector<CauseId> listed = listed_causes(a);
  const MarginalisedSystem& marginalised = marginalised_system(a);
  std::vector<Bound> result;
  for (const CauseId& cause : a.candidates.testable) {
    if (contains(listed, cause)) continue;
    const int column = best_regressor(a, cause);
    const EffectParameter& size = cause.effect->parameters.front();
    const double left = column < 0 ? 0.0 : marginalised.g.col(column).norm();
    if (column < 0 || left < kAbsorbed * raw_length(a, column)) {
      not_testable.push_back({cause, "calibrating the settings would hide its whole effect"});
      continue;
    }
    if (regressor(a, column).fixed) {
      // A skip has no bound on its size: it is absent, or it may act.
      if (probability_of(a, cause) < kMayAct)
        result.push_back({cause, std::string(size.name), 0.0});
      continue;
    }
    std::vector<int> set = a.decision.regressors;
    if (!contains(set, column)) set.push_back(column);
    const Estimate fitted = estimate_with(a, set);
    const Eigen::Index at = position_of(fitted, column);
    const double s = fitted.coefficient_sigma(at);
    const double most = std::max(std::abs(fitted.coefficient(at) + kQuantile95 * s),
                                 std::abs(fitted.coefficient(at) - kQuantile95 * s));
    const double upper = std::abs(size_at(regressor(a, column), most));
    if (upper >= std::max(std::abs(size.lower), std::abs(size.upper))) {
      not_testable.push_back(
          {cause,
           fmt::format("it could hide in these {}, whatever its size", a.session.units_word())});
    } else {
      result.push_back({cause, std::string(size.name), upper});
    }
  }
  return result;
}

std::vector<CalibratedSetting> settings_found(const Analysis& a) {
  const ObservationSet& session = a.session;
  std::vector<CalibratedSetting> result;
  for (std::size_t k = 0; k < session.settings.size(); ++k) {
    const auto at = as_index(k);
    if (!session.knows(k)) continue;
    CalibratedSetting one;
    one.setting = session.settings[k];
    one.stated = session.stated_value(at);
    one.stated_sigma = session.stated_sigma(at);
    one.calibrated = a.system.setting(at) + a.estimate.setting_change(at);
    one.sigma = std::sqrt(a.estimate.setting_covariance(at, at));
    // A posterior mean under the stated prior scatters by sqrt(prior - posterior).
    const double scatter = std::sqrt(std::max(
        one.stated_sigma * one.stated_sigma - one.sigma * one.sigma / a.estimate.noise_square,
        1e-6 * one.stated_sigma * one.stated_sigma));
    one.off = std::abs(one.calibrated - one.stated) > kSettingOff * scatter;
    result.push_back(one);
  }
  return result;
}

void take_findings(const Analysis& a, Diagnosis& d) {
  d.seed = a.options.seed;
  d.verdict = a.decision.verdict;
  d.noise_factor = std::sqrt(a.estimate.noise_square);
  d.family_wise_p = a.family_wise_p;
  d.causes = causes_found(a);
  d.hypotheses = hypotheses(a);
  d.not_testable = a.candidates.not_testable;
  d.bounds = bounds(a, d.not_testable);
}

namespace {

/// The residual of a one-row unit against the prediction by all others.
Outlier outlying_distance(const Analysis& a, const NumberedUnit& own, const SystemUnit& unit) {
  const Eigen::Index row = unit.first_row;
  // The prediction includes the others' information on its holes, and its uncertainty.
  const Eigen::VectorXd by_setting = a.system.by_setting.row(row);
  const double variance = a.estimate.noise_square + by_setting.dot(linear::product(
                                                        a.estimate.setting_covariance, by_setting));
  const double off = a.estimate.left_given_discrepancy(row);
  Outlier outlier;
  outlier.of = Observations::distances;
  outlier.index = own.index;
  outlier.residual_mm = off * unit.sigma();
  outlier.distance = std::abs(off) / std::sqrt(variance);
  return outlier;
}

Outlier outlying_point(const Analysis& a, const NumberedUnit& own, const SystemUnit& unit) {
  const Eigen::Vector2d chains = unit.unwhitened(a.estimate.left_given_discrepancy);
  Outlier outlier;
  outlier.index = own.index;
  // Where the tool would have to be, minus its mark.
  outlier.shift_mm = -tool_shift(a.system.places[unit.places.front().place], chains);
  const Eigen::Vector2d whitened = unit.whitening * chains;
  outlier.distance = whitened.norm() / std::sqrt(a.estimate.noise_square);
  return outlier;
}

}  // namespace

std::vector<Outlier> outliers_found(const Analysis& a) {
  std::vector<bool> outliers = marginalised_system(a).outliers;
  // A miscounted link is an outlier with a name.
  reject_slips(a, outliers);
  std::vector<Outlier> result;
  for (std::size_t u = 0; u < outliers.size(); ++u) {
    if (!outliers[u]) continue;
    const SystemUnit& unit = a.system.units[u];
    result.push_back(unit.reads_chains ? outlying_point(a, a.session.units[u], unit)
                                       : outlying_distance(a, a.session.units[u], unit));
    const ObservationPart& part = a.session.parts[a.session.units[u].part];
    if (&part.observation->kind() == &observation::drawn_measures)
      result.back().of = Observations::drawing;
  }
  sort(result, [](const Outlier& x, const Outlier& y) {
    return std::pair(x.of, x.index) < std::pair(y.of, y.index);
  });
  return result;
}

}  // namespace chaintrue::grid::diagnosis
