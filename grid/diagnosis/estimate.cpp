// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/estimate.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace chaintrue::grid::diagnosis {
namespace {

struct Solution {
  VectorXd value;
  MatrixXd covariance;
};

/// `settings`: the settings' expected change; the sizes' is zero.
Solution solve(const Unknowns& unknowns, const VectorXd& settings, VectorXd data,
               const LowRankNoise& noise) {
  const MatrixXd design = noise.half_solve(unknowns.design);
  data = noise.half_solve(data);
  VectorXd mean = VectorXd::Zero(design.cols());
  mean.head(settings.size()) = settings;
  linear::add_product(data, -1.0, design, mean);
  // Scaled by the priors the normal equations are well conditioned: I + S A'A S.
  const MatrixXd scaled = linear::scaled_columns(design, unknowns.sigma);
  const linear::Cholesky normal(linear::one_plus_gram(scaled));
  const VectorXd x = normal.solve(linear::inner(scaled, data));
  return {mean + unknowns.sigma.cwiseProduct(x),
          unknowns.sigma.asDiagonal() * normal.inverse() * unknowns.sigma.asDiagonal()};
}

}  // namespace

RegressorSet Estimate::free_regressors() const {
  return mapped(free, [&](std::size_t k) { return regressors[k]; });
}

Index Estimate::position(int regressor) const {
  return std::find(regressors.begin(), regressors.end(), regressor) - regressors.begin();
}

Unknowns unknowns_of(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                     const RegressorSet& free) {
  const Index settings = system.setting.size();
  const Index all = settings + std::ssize(free);
  Unknowns result{MatrixXd(marginalised.kept.size(), all), VectorXd(all)};
  result.design.leftCols(settings) = marginalised.kept(system.by_setting);
  result.sigma.head(settings) = system.sigma;
  for (Index k = settings; k < all; ++k) {
    const int column = free[as_size(k - settings)];
    result.design.col(k) = marginalised.kept(system.g.col(column));
    result.sigma(k) = wide_coefficient_sigma(system, marginalised, column);
  }
  return result;
}

Estimate estimate(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                  const RegressorSet& regressors, int discrepancy) {
  return estimate(system, marginalised, regressors,
                  discrepancy_noise(system, marginalised, discrepancy));
}

DiscrepancyNoise discrepancy_noise(const RegressorSystem& system,
                                   const MarginalisedSystem& marginalised, int discrepancy) {
  DiscrepancyNoise noise;
  if (discrepancy >= 0) noise.process = discrepancy_of(system, marginalised, discrepancy);
  noise.factor = discrepancy_columns(system, marginalised, discrepancy);
  noise.covariance = LowRankNoise(marginalised.kept(noise.factor));
  return noise;
}

Estimate estimate(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                  const RegressorSet& regressors, const DiscrepancyNoise& noise) {
  Estimate result;
  result.regressors = regressors;
  const auto settings = system.setting.size();
  result.coefficient = VectorXd::Zero(std::ssize(regressors));
  result.coefficient_sigma = result.coefficient;
  VectorXd data = system.e;
  for (const auto k : each_index(regressors)) {
    if (system.regressor(regressors[k]).fixed) {
      result.coefficient(as_index(k)) = 1.0;
      data -= system.g.col(regressors[k]);
    } else {
      result.free.push_back(k);
    }
  }
  Solution solution;
  // A coefficient that leaves its bounds is fixed there and the rest solved again.
  while (true) {
    solution = solve(unknowns_of(system, marginalised, result.free_regressors()),
                     system.expected_change, marginalised.kept(data), noise.covariance);
    std::size_t outside = result.free.size();
    for (const auto k : each_index(result.free)) {
      const Regressor& d = system.regressor(regressors[result.free[k]]);
      const double value = solution.value(settings + as_index(k));
      if (value < d.lowest || value > d.highest) outside = k;
    }
    if (outside == result.free.size()) break;
    const auto at = as_index(result.free[outside]);
    const Regressor& d = system.regressor(regressors[result.free[outside]]);
    result.coefficient(at) =
        std::clamp(solution.value(settings + as_index(outside)), d.lowest, d.highest);
    data -= system.g.col(regressors[result.free[outside]]) * result.coefficient(at);
    result.free.erase(result.free.begin() + static_cast<std::ptrdiff_t>(outside));
  }
  result.setting_change = solution.value.head(settings);
  result.left = std::move(data);
  linear::add_product(result.left, -1.0, system.by_setting, result.setting_change);
  for (const auto k : each_index(result.free)) {
    const auto at = as_index(result.free[k]);
    const Index column = settings + as_index(k);
    result.coefficient(at) = solution.value(column);
    result.left -= system.g.col(regressors[result.free[k]]) * result.coefficient(at);
  }
  result.left_given_discrepancy = result.left;
  const VectorXd kept = marginalised.kept(result.left);
  double quadratic = kept.squaredNorm();
  if (noise.is_of_process()) {
    result.discrepancy = noise.process;
    result.discrepancy_weights = noise.covariance.solve(kept);
    quadratic = kept.dot(result.discrepancy_weights);
    const VectorXd amplitudes =
        linear::inner(marginalised.kept(noise.factor), result.discrepancy_weights);
    linear::add_product(result.left_given_discrepancy, -1.0, noise.factor, amplitudes);
  }
  const VectorXd off = (result.setting_change - system.expected_change).cwiseQuotient(system.sigma);
  const NoiseDensity density(system.noise_dof, marginalised.kept.size());
  result.noise_square = density.noise_square(quadratic + off.squaredNorm());
  result.covariance = solution.covariance * result.noise_square;
  for (const auto k : each_index(result.free)) {
    const Index column = settings + as_index(k);
    result.coefficient_sigma(as_index(result.free[k])) =
        std::sqrt(result.covariance(column, column));
  }
  for (const auto k : each_index(regressors)) {
    const auto at = as_index(k);
    const bool is_fixed = system.regressor(regressors[k]).fixed;
    if (is_fixed || result.coefficient_sigma(at) > 0.0) continue;
    const double length = reduced(marginalised, system.g.col(regressors[k])).norm();
    result.coefficient_sigma(at) = std::sqrt(result.noise_square) / std::max(length, 1e-12);
  }
  return result;
}

VectorXd left_of_machine(const RegressorSystem& system, const Estimate& estimate,
                         const VectorXd& left) {
  if (system.nuisances == 0) return left;
  return left +
         linear::product(nuisance_columns(system), estimate.setting_change.tail(system.nuisances));
}

Vector2d error_of_unit(const RegressorSystem& system, const VectorXd& whitened, std::size_t unit) {
  const SystemUnit& own = system.units[unit];
  const Vector2d mm = own.unwhitened(whitened);
  return own.reads_chains ? tool_shift(system.places[own.places.front().place], mm) : mm;
}

std::vector<Vector2d> errors_of_units(const RegressorSystem& system, const VectorXd& whitened,
                                      const Indices& units) {
  return mapped(units, [&](std::size_t unit) { return error_of_unit(system, whitened, unit); });
}

double rms_of_units_mm(const RegressorSystem& system, const KeptRows& kept,
                       const VectorXd& whitened, const Indices& units) {
  double sum = 0.0;
  double count = 0.0;
  for (const KeptRows::Unit& unit : kept.units()) {
    if (unit.across || (!units.empty() && !contains(units, unit.unit))) continue;
    sum += error_of_unit(system, whitened, unit.unit).squaredNorm();
    // A place's four belts leave two checks.
    count += system.is_of_lengths() ? 2.0 : 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double noise_of_units_mm(const RegressorSystem& system, const Indices& units) {
  double sum = 0.0;
  for (const std::size_t unit : units) sum += noise_of_unit_mm2(system, unit).trace();
  return std::sqrt(sum / as_double(units.size()));
}

Matrix2d noise_of_unit_mm2(const RegressorSystem& system, std::size_t unit) {
  const SystemUnit& own = system.units[unit];
  Matrix2d noise = Matrix2d::Zero();
  if (!own.reads_chains) {
    const RowVectorXd nuisance = nuisance_columns(system).row(own.first_row) *
                                 system.sigma.tail(system.nuisances).asDiagonal();
    noise(0, 0) = std::pow(own.sigma(), 2) * (1.0 + nuisance.squaredNorm());
    return noise;
  }
  const Matrix2d to_tool =
      Matrix2d(own.whitening * system.places[own.places.front().place].state.by_mark).inverse();
  return to_tool * to_tool.transpose();
}

Vector2d tool_shift(const SystemPlace& place, const Vector2d& chain_mm) {
  // If chains are read too short, the model puts the tool nearer to the motors than it landed.
  return -(place.state.by_mark.inverse() * chain_mm);
}

}  // namespace chaintrue::grid::diagnosis
