// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/cause_parameters.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "grid/containers.hpp"
#include "grid/diagnosis/best_model.hpp"
#include "grid/diagnosis/regressor_places.hpp"
#include "interp/linear_algebra.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

using model::effects::EffectParameter;

double circular(double difference, const EffectParameter& p) {
  const bool turns = p.upper - p.lower >= 2.0 * std::numbers::pi;
  return turns ? std::remainder(difference, 2.0 * std::numbers::pi) : difference;
}

/// Derivative of a cause's whitened signature by its place; empty if the machine cannot have such
/// an effect.
std::optional<Eigen::VectorXd> slope_by_place(const Analysis& a,
                                              const Regressor& own,
                                              std::size_t which) {
  // Step in radians: central differences of a wave are accurate to h^2 / 6, rounding to 1e-16 / h.
  constexpr double kStep = 1e-3;
  std::vector<double> values = own.values;
  values[which] = own.values[which] + kStep;
  const auto above = signature(a.session, a.state, a.system, own.cause, values);
  values[which] = own.values[which] - kStep;
  const auto below = signature(a.session, a.state, a.system, own.cause, values);
  if (!above || !below) return std::nullopt;
  return (*above - *below) / (2.0 * kStep);
}

/// The same with each setting, n x q. A wave along a chain moves along it with the chain's length:
/// a motor that is off by half a millimetre moves the wave of a sprocket by 3 degrees. Empty if
/// such a machine is invalid.
Eigen::MatrixXd slope_by_settings(const Analysis& a, const Regressor& own) {
  // Step in sigmas: central differences of a wave of 60 mm are accurate to 1e-7 for a motor known
  // to 3 mm.
  constexpr double kStep = 1e-3;
  Eigen::MatrixXd slope =
      Eigen::MatrixXd::Zero(a.system.by_setting.rows(), a.system.setting.size());
  for (Eigen::Index column = 0; column < a.session.setting_columns(); ++column) {
    const double step = kStep * a.system.sigma(column);
    const auto at = [&](double change) -> std::optional<Eigen::VectorXd> {
      Eigen::VectorXd settings = a.system.setting;
      settings(column) += change;
      const auto state = moved_to(a.session, a.state, settings);
      if (!state) return std::nullopt;
      const auto there = linearise(a.session, *state);
      if (!there) return std::nullopt;
      return signature(a.session, *state, *there, own.cause, own.values);
    };
    const auto above = at(step);
    const auto below = at(-step);
    if (above && below) slope.col(column) = (*above - *below) / (2.0 * step);
  }
  return slope;
}

/// Distance from a continuous place to the nearest other one tried.
double step_of_places(const Analysis& a, const Regressor& own, std::size_t which) {
  double least = kInfinity;
  for (const Regressor& other : a.system.regressors) {
    if (!(other.cause == own.cause)) continue;
    const double step = std::abs(other.values[which] - own.values[which]);
    if (step > 0.0) least = std::min(least, step);
  }
  return std::isfinite(least) ? least : 0.0;
}

/// Sigma of a continuous place from the curvature of the likelihood, with settings and all
/// coefficients free.
double fitted_place_sigma(const Analysis& a,
                          int column,
                          std::size_t which,
                          const Estimate& fitted,
                          double coefficient,
                          const Eigen::VectorXd& slope) {
  const Regressor& own = regressor(a, column);
  const EffectParameter& place = own.cause.effect->parameters[which];
  const MarginalisedSystem& marginalised = marginalised_system(a);
  const RegressorSystem& system = a.system;
  const Eigen::Index settings = system.setting.size();
  const auto free = std::ssize(fitted.free);
  Eigen::MatrixXd design(marginalised.kept.size(), settings + free + 1);
  Eigen::VectorXd sigma(settings + free + 1);
  design.leftCols(settings) =
      marginalised.kept.of(system.by_setting + coefficient * slope_by_settings(a, own));
  sigma.head(settings) = system.sigma;
  for (Eigen::Index k = 0; k < free; ++k) {
    const int other = fitted.regressors[fitted.free[as_size(k)]];
    design.col(settings + k) = marginalised.kept(system.g.col(other));
    sigma(settings + k) = wide_coefficient_sigma(system, marginalised, other);
  }
  design.col(settings + free) = coefficient * marginalised.kept(slope);
  // The prior is uniform between the bounds; a phase is cyclic.
  const double range = place.name.ends_with("_rad")
                           ? std::min(place.upper - place.lower, 2.0 * std::numbers::pi)
                           : place.upper - place.lower;
  sigma(settings + free) = range / std::sqrt(12.0);
  if (a.noise) a.noise->covariance.half_solve_in_place(design);
  const Eigen::MatrixXd scaled =
      linear::scaled_columns(design, sigma / std::sqrt(fitted.noise_square));
  const linear::Cholesky normal(linear::one_plus_gram(scaled));
  const Eigen::Index last = settings + free;
  const Eigen::VectorXd column_of_inverse =
      normal.solve(Eigen::VectorXd::Unit(last + 1, last));
  // With a discrepancy the place is the best of those tried (relinearise.cpp), off by up to half a
  // step either way.
  const double step = a.noise ? step_of_places(a, own, which) : 0.0;
  return std::hypot(sigma(last) * std::sqrt(column_of_inverse(last)), step / std::sqrt(12.0));
}

/// Uncertainty of where a cause sets in: the scatter of that parameter over the models, about a
/// value.
double place_scatter(const Analysis& a, int column, std::size_t which, double about) {
  const Regressor& own = regressor(a, column);
  const EffectParameter& place = own.cause.effect->parameters[which];
  double weight = 0.0;
  double square = 0.0;
  for (const CandidateModel& model : a.comparison.models) {
    for (const int k : model.regressors) {
      const Regressor& other = regressor(a, k);
      if (!(other.cause == own.cause)) continue;
      const double p = a.comparison.probability(model);
      const double off = circular(other.values[which] - about, place);
      weight += p;
      square += p * off * off;
    }
  }
  return weight > 0.0 ? std::sqrt(square / weight) : 0.0;
}

/// The models contain only a few values of a continuous place: if one has all the weight, their
/// scatter does not show the uncertainty.
ParameterEstimate estimated_place(
    const Analysis& a, int column, std::size_t which, const Estimate& fitted, double coefficient) {
  const Regressor& own = regressor(a, column);
  const EffectParameter& place = own.cause.effect->parameters[which];
  ParameterEstimate result{std::string(place.name), own.values[which], 0.0};
  double width = 0.0;
  if (!place.integer) {
    const auto slope = slope_by_place(a, own, which);
    const bool is_step = slope && slope->isZero();
    if (slope && !is_step) width = fitted_place_sigma(a, column, which, fitted, coefficient, *slope);
    // No reading shows where between two of them a step is.
    if (const auto gap = is_step ? gap_about(a.system, own.cause, result.value) : std::nullopt) {
      result.value = 0.5 * (gap->below + gap->above);
      width = (gap->above - gap->below) / std::sqrt(12.0);
    }
  }
  result.sigma = std::max(place_scatter(a, column, which, result.value), width);
  return result;
}

}  // namespace

Eigen::Index position_of(const Estimate& e, int column) {
  const auto found = std::find(e.regressors.begin(), e.regressors.end(), column);
  return as_index(found - e.regressors.begin());
}

std::vector<ParameterEstimate> parameters_of(const Analysis& a, int column, const Estimate& fitted) {
  const Regressor& d = regressor(a, column);
  const Eigen::Index at = position_of(fitted, column);
  const double coefficient = fitted.coefficient(at);
  const double sigma = fitted.coefficient_sigma(at);
  std::vector<ParameterEstimate> result;
  const auto& described = d.cause.effect->parameters;
  result.push_back({std::string(described.front().name),
                    size_at(d, coefficient),
                    std::abs(size_slope(d, coefficient)) * sigma});
  for (std::size_t k = 1; k < described.size(); ++k)
    result.push_back(estimated_place(a, column, k, fitted, coefficient));
  return result;
}

}  // namespace chaintrue::grid::diagnosis
