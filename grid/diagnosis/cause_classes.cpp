// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <optional>

#include "grid/diagnosis/decision.hpp"

#include "grid/diagnosis/estimate.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

bool on_paper(const CauseId& cause) { return cause.effect->station == Station::paper; }

/// A cause's signature with the settings free, and with what was stated of them.
struct Representative {
  VectorXd free;
  VectorXd stated;
  CauseId cause;
  bool fixed = false;
  bool mixed = false;  ///< its class has whole numbers and any amounts
};

/// The best model in which one of these acts together with the free one.
struct FreeModel {
  RegressorSet regressors;
  int free = -1;
  std::size_t marginalised = 0;
};
std::optional<FreeModel> model_with(const RegressorSystem& system,
                                    const ModelComparison& comparison, const CauseId& whole,
                                    const CauseId& free) {
  const auto regressor = [&](int k) -> const Regressor& { return system.regressor(k); };
  for (const CandidateModel& model : comparison.models) {
    FreeModel found{{}, -1, model.marginalised};
    for (const int k : model.regressors) {
      if (regressor(k).cause == free) found.free = k;
      if (regressor(k).cause != whole) {
        found.regressors.push_back(k);
        continue;
      }
      for (const int other : system.regressors_of(free)) {
        if (regressor(other).values.back() == regressor(k).values.back()) found.free = other;
      }
      if (found.free >= 0) found.regressors.push_back(found.free);
    }
    if (found.free < 0) continue;
    sort_unique(found.regressors);
    return found;
  }
  return std::nullopt;
}

/// Within the noise, the fitted size of `free` is a whole number of `whole`.
bool is_whole(const RegressorSystem& system, const ModelComparison& comparison,
              const CauseId& whole, const CauseId& free) {
  constexpr double kSigmas = 3.0;  // 1 in 370
  const auto model = model_with(system, comparison, whole, free);
  if (!model) return false;
  const Estimate found =
      estimate(system, comparison.marginalised_systems[model->marginalised], model->regressors, -1);
  const Index at = found.position(model->free);
  const VectorXd own = system.g.col(model->free);
  const Regressor& of_free = system.regressor(model->free);
  for (const int k : system.regressors_of(whole)) {
    if (system.regressor(k).values.back() != of_free.values.back()) continue;
    const double asked = own.dot(VectorXd(system.g.col(k))) / own.squaredNorm();
    if (std::abs(found.coefficient(at) - asked) <= kSigmas * found.coefficient_sigma(at))
      return true;
  }
  return false;
}

bool one_class(const RegressorSystem& system, const ModelComparison& comparison,
               const Representative& a, const Representative& b) {
  if (collinearity_of(a.free.dot(b.free), a.free.norm() * b.free.norm()) < kOneClass) return false;
  if (!a.fixed && !b.fixed) return true;
  // A whole link is large: if it needs an implausible chain zero, it is distinguished.
  if (collinearity_of(a.stated.dot(b.stated), a.stated.norm() * b.stated.norm()) < kOneClass)
    return false;
  // A whole number of teeth differs from an arbitrary amount.
  return a.fixed == b.fixed || (a.fixed ? is_whole(system, comparison, a.cause, b.cause)
                                        : is_whole(system, comparison, b.cause, a.cause));
}

/// A whole number and an arbitrary amount, the likelier first: the whole number has no free size
/// and so leads if the amount fits it.
void put_likelier_first(const RegressorSystem& system, const ModelComparison& comparison,
                        CauseClass& members) {
  const auto weight_of = [&](const CauseId& cause) {
    double sum = kMinusInfinity;
    for (const CandidateModel& model : comparison.models) {
      const bool acts =
          any_of(model.regressors, [&](int k) { return system.regressor(k).cause == cause; });
      if (acts) sum = log_sum(sum, model.log_weight);
    }
    return sum;
  };
  const auto end = std::find_if(members.begin(), members.end(), on_paper);
  std::stable_sort(members.begin(), end, descending(weight_of));
}

/// An orthonormal basis of the settings' effects. Directions that would need implausible settings
/// are dropped: distances hardly depend on some settings.
MatrixXd range_of_settings(const RegressorSystem& system, const MatrixXd& columns) {
  constexpr double kFelt = 1e-4;
  if (system.nuisances == 0) return linear::orthonormal_columns(columns);
  return linear::range_of(linear::scaled_columns(columns, system.sigma.head(columns.cols())), kFelt)
      .range;
}

}  // namespace

std::vector<std::pair<CauseId, int>> best_regressors(const RegressorSystem& system,
                                                     const MarginalisedSystem& marginalised) {
  const VectorXd c = with_regressors(system, marginalised, marginalised.e);
  const VectorXd square = squared_lengths(system, marginalised);
  std::vector<std::pair<CauseId, int>> result;
  double best = -1.0;
  for (const auto k : each_index(system.regressors)) {
    const auto at = as_index(k);
    if (!(square(at) > 1e-8)) continue;
    const double score = std::abs(c(at)) / std::sqrt(square(at));
    if (result.empty() || result.back().first != system.regressors[k].cause) {
      result.emplace_back(system.regressors[k].cause, as_int(k));
      best = score;
    } else if (score > best) {
      result.back().second = as_int(k);
      best = score;
    }
  }
  return result;
}

std::vector<CauseClass> classes_of(const RegressorSystem& system,
                                   const ModelComparison& comparison) {
  const MarginalisedSystem& marginalised = comparison.best_system();
  // Settings are free, so that classes do not depend on how well they were stated.
  const LowRankNoise noise = nuisance_noise(system, marginalised.kept);
  const auto visible = [&](const MatrixXd& columns) { return noise.half_solve(columns); };
  const Index settings = system.by_setting.cols() - system.nuisances;
  const MatrixXd basis =
      range_of_settings(system, visible(marginalised.kept(system.by_setting.leftCols(settings))));
  std::vector<CauseClass> classes;
  std::vector<Representative> first;
  for (const auto& [cause, column] : best_regressors(system, marginalised)) {
    Representative own{visible(marginalised.kept(system.g.col(column))),
                       reduced(marginalised, system.g.col(column)), cause,
                       system.regressor(column).fixed};
    const double whole = own.free.norm();
    linear::add_product(own.free, -1.0, basis, linear::inner(basis, own.free));
    // If the settings absorb a signature, only rounding would be compared.
    if (own.free.norm() < kAbsorbed * whole) own.free.setZero();
    auto* same = find_where(first, [&](const Representative& other) {
      return one_class(system, comparison, own, other);
    });
    const std::size_t home = same != nullptr ? as_size(same - first.data()) : first.size();
    if (same != nullptr) {
      same->mixed = same->mixed || own.fixed != same->fixed;
    } else {
      classes.emplace_back();
      first.push_back(std::move(own));
    }
    classes[home].push_back(cause);
  }
  for (const auto k : each_index(classes)) {
    CauseClass& members = classes[k];
    std::stable_partition(members.begin(), members.end(), std::not_fn(on_paper));
    if (first[k].mixed) put_likelier_first(system, comparison, members);
  }
  return classes;
}

}  // namespace chaintrue::grid::diagnosis
