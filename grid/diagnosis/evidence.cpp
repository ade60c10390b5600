// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "grid/diagnosis/normal.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// log of the chance that a normal lies in [low, high].
double log_mass(double mean, double sigma, double low, double high) {
  return log_normal_mass((low - mean) / sigma, (high - mean) / sigma);
}

}  // namespace

NoiseDensity::NoiseDensity(double dof, Eigen::Index rows)
    : dof_(dof),
      rows_(static_cast<double>(rows)),
      constant_(std::lgamma(0.5 * (rows_ + dof)) - std::lgamma(0.5 * dof) -
                0.5 * rows_ * std::log(std::numbers::pi)) {}

double NoiseDensity::part(double scale, double quadratic) const {
  const double anchor = dof_ * scale * scale;
  return constant_ + 0.5 * dof_ * std::log(anchor) -
         0.5 * (rows_ + dof_) * std::log(anchor + quadratic);
}

double NoiseDensity::log_density_as_stated(double quadratic) const {
  return std::log(1.0 - kLargerNoisePrior) + part(1.0, quadratic);
}

double NoiseDensity::log_density(double quadratic) const {
  double sum = log_density_as_stated(quadratic);
  for (const double scale : kLargerNoise) {
    sum = log_sum(sum,
                  std::log(kLargerNoisePrior / std::size(kLargerNoise)) + part(scale, quadratic));
  }
  return sum;
}

double NoiseDensity::larger_share(double quadratic) const {
  return 1.0 - std::exp(log_density_as_stated(quadratic) - log_density(quadratic));
}

double NoiseDensity::noise_square(double quadratic) const {
  const double all = log_density(quadratic);
  const double more = rows_ + dof_ - 2.0;
  double sum = std::exp(std::log(1.0 - kLargerNoisePrior) + part(1.0, quadratic) - all) *
               (dof_ + quadratic) / more;
  for (const double scale : kLargerNoise) {
    sum += std::exp(std::log(kLargerNoisePrior / std::size(kLargerNoise)) + part(scale, quadratic) -
                    all) *
           (dof_ * scale * scale + quadratic) / more;
  }
  return sum;
}

double log_price_of_outlier(Eigen::Index rows) {
  return std::log(kOutlierPrior) -
         0.5 * static_cast<double>(rows) *
             std::log(2.0 * std::numbers::pi * kOutlierSpread * kOutlierSpread);
}

double log_price_of_outliers(const RegressorSystem& system, const std::vector<bool>& outliers) {
  std::array<double, 2> rejected{};
  if (system.groups.empty()) {
    for (std::size_t u = 0; u < outliers.size(); ++u) {
      if (outliers[u]) rejected[static_cast<std::size_t>(system.units[u].rows - 1)] += 1.0;
    }
  } else {
    // Each direction is a slip of its own, and a unit has no more of them than rows.
    std::vector<Eigen::Index> of_unit(system.units.size(), 0);
    for (std::size_t k = 0; k < outliers.size(); ++k) {
      const OutlierGroup& group = system.groups[k];
      const int unit = system.unit_of_row[static_cast<std::size_t>(group.first_row)];
      Eigen::Index& own = of_unit[static_cast<std::size_t>(unit)];
      if (outliers[k]) own = std::min(own + (group.direction ? 1 : group.rows), group.rows);
    }
    for (const Eigen::Index directions : of_unit) rejected[0] += static_cast<double>(directions);
  }
  return rejected[0] * log_price_of_outlier(1) + rejected[1] * log_price_of_outlier(2);
}

MarginalisedSystem marginalise(const RegressorSystem& system,
                               const std::vector<bool>& outliers,
                               const Steps& steps) {
  MarginalisedSystem marginalised;
  marginalised.outliers = outliers;
  marginalised.kept = KeptRows(system, outliers);
  marginalised.log_outliers = log_price_of_outliers(system, outliers);
  const Eigen::MatrixXd a = marginalised.kept.of(system.by_setting);
  Eigen::VectorXd e = marginalised.kept(system.e);
  if (steps.project_settings) {
    marginalised.root = CovarianceRoot(a * system.sigma.asDiagonal());
    e -= a * system.expected_change;
  } else {
    marginalised.root = CovarianceRoot(Eigen::MatrixXd(a.rows(), 0));
  }
  marginalised.log_det = marginalised.root.log_det();
  marginalised.e = marginalised.root.solve(e);
  marginalised.g = system.g.mapped([&](const auto& columns) {
    return marginalised.root.solve(marginalised.kept.of(columns));
  });
  return marginalised;
}

Eigen::LLT<Eigen::MatrixXd> nuisance_noise(const RegressorSystem& system,
                                           const KeptRows& kept) {
  if (system.nuisances == 0) return {};
  const Eigen::MatrixXd scaled =
      kept.of(nuisance_columns(system)) * system.sigma.tail(system.nuisances).asDiagonal();
  Eigen::MatrixXd covariance = scaled * scaled.transpose();
  covariance.diagonal().array() += 1.0;
  return Eigen::LLT<Eigen::MatrixXd>(covariance);
}

double square_in_noise(const RegressorSystem& system,
                       const KeptRows& kept,
                       const Eigen::VectorXd& column) {
  Eigen::VectorXd own = kept(column);
  if (system.nuisances > 0) nuisance_noise(system, kept).matrixL().solveInPlace(own);
  return own.squaredNorm();
}

double length_in_noise(const RegressorSystem& system,
                       const KeptRows& kept,
                       const Eigen::VectorXd& column) {
  return std::sqrt(square_in_noise(system, kept, column));
}

Eigen::VectorXd reduced(const MarginalisedSystem& marginalised, const Eigen::VectorXd& column) {
  return marginalised.root.solve(marginalised.kept(column));
}

double wide_coefficient_sigma(const RegressorSystem& system,
                              const MarginalisedSystem& marginalised,
                              int regressor) {
  const double usual = system.regressors[static_cast<std::size_t>(regressor)].coefficient_sigma;
  if (usual > 0.0) return usual * kWideSignalToNoise / kUsualSignalToNoise;
  return kWideSignalToNoise / std::max(marginalised.g.col(regressor).norm(), 1e-12);
}

Eigen::Index NormalEquations::position(int column) const {
  const auto found = std::lower_bound(columns.begin(), columns.end(), column);
  return static_cast<Eigen::Index>(found - columns.begin());
}

Eigen::VectorXd prior_squares(const std::vector<Regressor>& regressors,
                              const std::vector<int>& columns,
                              Eigen::VectorXd squares) {
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const double sigma = regressors[static_cast<std::size_t>(columns[i])].coefficient_sigma;
    if (sigma > 0.0) squares(static_cast<Eigen::Index>(i)) = std::pow(kUsualSignalToNoise / sigma, 2);
  }
  return squares;
}

NormalEquations normal_equations(const RegressorSystem& system,
                                 const MarginalisedSystem& marginalised,
                                 std::vector<int> columns) {
  NormalEquations equations;
  std::sort(columns.begin(), columns.end());
  equations.columns = std::move(columns);
  const Eigen::MatrixXd g = marginalised.g.dense(equations.columns);
  equations.ee = marginalised.e.squaredNorm();
  equations.ge = g.transpose() * marginalised.e;
  equations.gg = g.transpose() * g;
  equations.prior_square =
      prior_squares(system.regressors, equations.columns, equations.gg.diagonal());
  equations.log_det = marginalised.log_det;
  return equations;
}

Discrepancy discrepancy_of(const RegressorSystem& system,
                           const MarginalisedSystem& marginalised,
                           int discrepancy) {
  const DiscrepancyFamily& family = *system.discrepancies;
  const std::size_t number = family.kernel_of(discrepancy);
  const DiscrepancyKernel& kernel = family.kernels[number];
  double trace = number < marginalised.discrepancy_trace.size()
                     ? marginalised.discrepancy_trace[number]
                     : 0.0;
  if (!(trace > 0.0)) {
    // A kernel that was tried with other readings rejected.
    const Eigen::MatrixXd half =
        marginalised.root.solve(discrepancy_covariance(system, marginalised.kept, kernel));
    trace = marginalised.root.solve(half.transpose()).trace();
  }
  return {kernel, family.strength_of(discrepancy) / std::sqrt(std::max(trace, 1e-300))};
}

namespace {

/// Set evidence for one prior sigma of the signal-to-noise ratio.
SetEvidence evidence_at(const NormalEquations& equations,
                        const std::vector<Regressor>& regressors,
                        std::span<const Eigen::Index> set,
                        const NoiseDensity& noise,
                        double prior_sigma) {
  SetEvidence result;
  std::vector<Eigen::Index> free;
  const auto regressor = [&](Eigen::Index i) -> const Regressor& {
    return regressors[static_cast<std::size_t>(equations.columns[static_cast<std::size_t>(i)])];
  };
  double q = equations.ee;
  for (const Eigen::Index i : set) {
    if (!regressor(i).fixed) {
      free.push_back(i);
      continue;
    }
    q -= 2.0 * equations.ge(i);
    for (const Eigen::Index j : set) {
      if (regressor(j).fixed) q += equations.gg(i, j);
    }
  }
  const auto m = static_cast<Eigen::Index>(free.size());
  Eigen::VectorXd c(m);
  Eigen::VectorXd length(m);
  Eigen::VectorXd prior(m);  // one sigma of the signal-to-noise ratio in this metric
  Eigen::MatrixXd a(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index at = free[static_cast<std::size_t>(i)];
    if (!(equations.gg(at, at) > 0.0)) {
      // Rows that see nothing of a cause, others being left out, say nothing for it.
      result.log_evidence = -std::numeric_limits<double>::infinity();
      return result;
    }
    length(i) = std::sqrt(equations.gg(at, at));
    prior(i) = prior_sigma * length(i) / std::sqrt(equations.prior_square(at));
    c(i) = equations.ge(at);
    for (const Eigen::Index j : set) {
      if (regressor(j).fixed) c(i) -= equations.gg(at, j);
    }
    c(i) /= length(i);
    for (Eigen::Index j = 0; j <= i; ++j) {
      a(i, j) = a(j, i) =
          equations.gg(at, free[static_cast<std::size_t>(j)]) / (length(i) * length(j));
    }
    a(i, i) += 1.0 / (prior(i) * prior(i));
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(a);
  result.signal_to_noise = llt.solve(c);
  result.quadratic = std::max(q - c.dot(result.signal_to_noise), 0.0);
  result.signal_to_noise_variance = llt.solve(Eigen::MatrixXd::Identity(m, m)).diagonal();
  const double half_log_det = Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
  result.log_evidence = noise.log_density(result.quadratic) - 0.5 * equations.log_det -
                        half_log_det - prior.array().log().sum();
  const double s = std::sqrt(noise.noise_square(result.quadratic));
  for (Eigen::Index i = 0; i < m; ++i) {
    const Regressor& own = regressor(free[static_cast<std::size_t>(i)]);
    const double low = own.lowest * length(i);
    const double high = own.highest * length(i);
    // Further beyond what it may be than noise takes it, and not merely about null: the data ask
    // for something else.
    const double slack = 2.0 * s * std::sqrt(result.signal_to_noise_variance(i));
    const double reach = own.refined ? 1.0 : 2.0;
    if (result.signal_to_noise(i) > reach * high + slack ||
        (low < 0.0 && result.signal_to_noise(i) < reach * low - slack)) {
      result.log_evidence = kMinusInfinity;
      return result;
    }
    result.log_evidence += log_mass(result.signal_to_noise(i),
                                    s * std::sqrt(result.signal_to_noise_variance(i)),
                                    low,
                                    high) -
                           log_mass(0.0, s * prior(i), low, high);
  }
  return result;
}

}  // namespace

SetEvidence set_evidence(const NormalEquations& equations,
                         const std::vector<Regressor>& regressors,
                         std::span<const Eigen::Index> set,
                         const NoiseDensity& noise) {
  SetEvidence wide = evidence_at(equations, regressors, set, noise, kWideSignalToNoise);
  const bool all_fixed = wide.signal_to_noise.size() == 0;
  if (all_fixed) return wide;
  const SetEvidence usual = evidence_at(equations, regressors, set, noise, kUsualSignalToNoise);
  wide.log_evidence = log_sum(std::log(1.0 - kWideSignalToNoisePrior) + usual.log_evidence,
                              std::log(kWideSignalToNoisePrior) + wide.log_evidence);
  return wide;
}

}  // namespace chaintrue::grid::diagnosis
