// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/evidence.hpp"

#include <fmt/format.h>

#include <numbers>
#include <utility>

#include "grid/statistics.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

/// log of the probability that a normal lies in [low, high].
double log_mass(double mean, double sigma, double low, double high) {
  return log_normal_mass((low - mean) / sigma, (high - mean) / sigma);
}

}  // namespace

NoiseDensity::NoiseDensity(double dof, Index rows) : dof_(dof), rows_(as_double(rows)) {
  const double constant = std::lgamma(0.5 * (rows_ + dof)) - std::lgamma(0.5 * dof) -
                          0.5 * rows_ * std::log(std::numbers::pi);
  const auto component = [&](double scale, double prior) {
    const double anchor = dof * scale * scale;
    return Component{anchor, std::log(prior) + constant + 0.5 * dof * std::log(anchor)};
  };
  components_.front() = component(1.0, 1.0 - kLargerNoisePrior);
  for (const std::size_t k : each_below(std::size(kLargerNoise)))
    components_[k + 1] = component(kLargerNoise[k], kLargerNoisePrior / std::size(kLargerNoise));
}

double NoiseDensity::part(const Component& component, double quadratic) const {
  return component.constant - 0.5 * (rows_ + dof_) * std::log(component.anchor + quadratic);
}

double NoiseDensity::log_density_as_stated(double quadratic) const {
  return part(components_.front(), quadratic);
}

NoiseDensity::Averages NoiseDensity::averages(double quadratic) const {
  std::array<double, std::tuple_size_v<decltype(components_)>> log_parts;
  for (const auto k : each_index(log_parts)) log_parts[k] = part(components_[k], quadratic);
  const double most = *max_element(log_parts);
  double sum = 0.0;
  double squares = 0.0;
  double as_stated = 0.0;
  for (const auto k : each_index(log_parts)) {
    const double share = std::exp(log_parts[k] - most);
    sum += share;
    squares += share * (components_[k].anchor + quadratic);
    if (k == 0) as_stated = share;
  }
  return {most + std::log(sum), squares / sum / (rows_ + dof_ - 2.0), 1.0 - as_stated / sum};
}

double log_price_of_outlier(Index rows) {
  return std::log(kOutlierPrior) -
         0.5 * as_double(rows) * std::log(2.0 * std::numbers::pi * kOutlierSpread * kOutlierSpread);
}

double log_price_of_outliers(const RegressorSystem& system, const Flags& outliers) {
  double price = 0.0;
  Rows directions(system.units.size(), 0);
  for (const auto k : each_index(outliers)) {
    const OutlierGroup& group = system.groups[k];
    if (!outliers[k]) continue;
    if (!group.direction) {
      price += log_price_of_outlier(group.rows);
    } else if (directions[system.unit_of(group)]++ < group.rows) {
      price += log_price_of_outlier(1);
    }
  }
  return price;
}

MarginalisedSystem marginalise(const RegressorSystem& system, const Flags& outliers) {
  MarginalisedSystem marginalised;
  marginalised.outliers = outliers;
  marginalised.kept = KeptRows(system, outliers);
  marginalised.log_outliers = log_price_of_outliers(system, outliers);
  const MatrixXd a = marginalised.kept(system.by_setting);
  VectorXd e = marginalised.kept(system.e);
  linear::add_product(e, -1.0, a, system.expected_change);
  marginalised.root = CovarianceRoot(linear::scaled_columns(a, system.sigma));
  marginalised.log_det = marginalised.root.log_det();
  marginalised.e = marginalised.root.solve(e);
  return marginalised;
}

VectorXd squared_lengths(const RegressorSystem& system, const MarginalisedSystem& marginalised) {
  const KeptRows& kept = marginalised.kept;
  const MatrixXd explained = system.g.transpose_times(kept.spread(marginalised.root.explained()));
  return (system.g.squared_norms(kept) - explained.rowwise().squaredNorm()).cwiseMax(0.0);
}

LowRankNoise nuisance_noise(const RegressorSystem& system, const KeptRows& kept) {
  return LowRankNoise(
      linear::scaled_columns(kept(nuisance_columns(system)), system.sigma.tail(system.nuisances)));
}

double length_in_noise(const RegressorSystem& system, const KeptRows& kept,
                       const VectorXd& column) {
  return nuisance_noise(system, kept).half_solve(kept(column)).norm();
}

VectorXd left_by(const KeptRows& kept, const MatrixXd& columns, const VectorXd& sigma,
                 VectorXd rows) {
  const MatrixXd scaled = linear::scaled_columns(kept(columns), sigma);
  const VectorXd x =
      linear::Cholesky(linear::one_plus_gram(scaled)).solve(linear::inner(scaled, kept(rows)));
  linear::add_product(rows, -1.0, columns, sigma.cwiseProduct(x));
  return rows;
}

double wide_coefficient_sigma(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                              int regressor) {
  const double usual = system.regressor(regressor).coefficient_sigma;
  if (usual > 0.0) return usual * kWideSignalToNoise / kUsualSignalToNoise;
  const double length = reduced(marginalised, system.g.col(regressor)).norm();
  return kWideSignalToNoise / std::max(length, 1e-12);
}

ColumnSet NormalEquations::positions(const RegressorSet& some) const {
  return mapped(some, [&](int k) {
    return std::lower_bound(columns.begin(), columns.end(), k) - columns.begin();
  });
}

VectorXd prior_squares(const std::vector<Regressor>& regressors, const RegressorSet& columns,
                       VectorXd squares) {
  for (const auto i : each_index(columns)) {
    const double sigma = regressors[as_size(columns[i])].coefficient_sigma;
    if (sigma > 0.0) squares(as_index(i)) = std::pow(kUsualSignalToNoise / sigma, 2);
  }
  return squares;
}

NormalEquations normal_equations(const RegressorSystem& system,
                                 const MarginalisedSystem& marginalised, RegressorSet columns) {
  sort(columns);
  const MatrixXd g = reduced(marginalised, system.g.dense(columns));
  return normal_equations(system.regressors, marginalised, std::move(columns), g);
}

NormalEquations normal_equations(const std::vector<Regressor>& regressors,
                                 const MarginalisedSystem& marginalised, RegressorSet columns,
                                 const MatrixXd& g) {
  NormalEquations equations;
  equations.rows.resize(g.rows(), 1 + g.cols());
  equations.rows << marginalised.e, g;
  equations.ee = marginalised.e.squaredNorm();
  equations.ge = linear::inner(g, marginalised.e);
  equations.gg = linear::gram(g);
  equations.prior_square = prior_squares(regressors, columns, equations.gg.diagonal());
  equations.columns = std::move(columns);
  equations.log_det = marginalised.log_det;
  return equations;
}

Discrepancy discrepancy_of(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                           int discrepancy) {
  const DiscrepancyFamily& family = *system.discrepancies;
  const std::size_t number = family.kernel_of(discrepancy);
  const DiscrepancyKernel& kernel = family.kernels[number];
  double trace =
      number < marginalised.discrepancy_trace.size() ? marginalised.discrepancy_trace[number] : 0.0;
  if (!(trace > 0.0)) {
    // A kernel that was tried with other readings rejected.
    trace = reduced(marginalised, discrepancy_factor(system, kernel)).squaredNorm();
  }
  return {kernel, family.strength_of(discrepancy) / std::sqrt(std::max(trace, 1e-300))};
}

MatrixXd discrepancy_columns(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                             int discrepancy) {
  if (discrepancy < 0) return MatrixXd(system.e.size(), 0);
  const Discrepancy process = discrepancy_of(system, marginalised, discrepancy);
  return process.sigma_mm * discrepancy_factor(system, process.kernel);
}

namespace {

using FewValues = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostFreeRegressors, 1>;
using FewByFew = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                               kMostFreeRegressors, kMostFreeRegressors>;

/// A set's equations in the signal-to-noise ratios of its free regressors, the fixed ones taken from the data.
struct FreeEquations {
  double ee = 0.0;
  FewValues c;             ///< right-hand side
  FewByFew gram;           ///< correlations
  FewValues prior_length;  ///< a signal-to-noise ratio in this metric over one in the prior's
  FewValues low, high;     ///< bounds of the ratios
  std::array<bool, kMostFreeRegressors> refined{};
  bool is_empty_column = false;  ///< the kept rows do not depend on a regressor
};

FreeEquations free_equations(const NormalEquations& equations,
                             const std::vector<Regressor>& regressors, std::span<const Index> set) {
  const auto regressor = [&](Index i) -> const Regressor& {
    return regressors[as_size(equations.columns[as_size(i)])];
  };
  std::array<Index, kMostFreeRegressors> free{};
  Index m = 0;
  FreeEquations result;
  result.ee = equations.ee;
  for (const Index i : set) {
    if (!regressor(i).fixed) {
      if (m == kMostFreeRegressors)
        throw std::length_error(
            fmt::format("a set of {} regressors, at most {}", set.size(), kMostFreeRegressors));
      free[as_size(m++)] = i;
      continue;
    }
    result.ee -= 2.0 * equations.ge(i);
    for (const Index j : set) {
      if (regressor(j).fixed) result.ee += equations.gg(i, j);
    }
  }
  FewValues length(m);
  for (FewValues* values : {&result.c, &result.prior_length, &result.low, &result.high})
    values->resize(m);
  result.gram.resize(m, m);
  for (const Index i : each_below(m)) {
    const Index at = free[as_size(i)];
    const Regressor& own = regressor(at);
    if (!(equations.gg(at, at) > 0.0)) {
      result.is_empty_column = true;
      return result;
    }
    length(i) = std::sqrt(equations.gg(at, at));
    result.prior_length(i) = length(i) / std::sqrt(equations.prior_square(at));
    result.low(i) = own.lowest * length(i);
    result.high(i) = own.highest * length(i);
    result.refined[as_size(i)] = own.refined;
    double right = equations.ge(at);
    for (const Index j : set) {
      if (regressor(j).fixed) right -= equations.gg(at, j);
    }
    result.c(i) = right / length(i);
    for (Index j = 0; j <= i; ++j) {
      result.gram(i, j) = result.gram(j, i) =
          equations.gg(at, free[as_size(j)]) / (length(i) * length(j));
    }
  }
  return result;
}

/// Replaces a positive definite matrix by its inverse, by Gauss-Jordan elimination; returns its determinant.
double invert(FewByFew& a) {
  double determinant = 1.0;
  for (const Index k : each_below(a.rows())) {
    const double pivot = std::exchange(a(k, k), 1.0);
    determinant *= pivot;
    for (const Index j : each_below(a.cols())) a(k, j) /= pivot;
    for (const Index i : each_below(a.rows())) {
      if (i == k) continue;
      const double factor = std::exchange(a(i, k), 0.0);
      for (const Index j : each_below(a.cols())) a(i, j) -= factor * a(k, j);
    }
  }
  return determinant;
}

/// Set evidence for one prior sigma of the signal-to-noise ratio.
SetEvidence evidence_at(const FreeEquations& free, double log_det, const NoiseDensity& noise,
                        double prior_sigma) {
  const Index m = free.c.size();
  const FewValues prior = prior_sigma * free.prior_length;
  FewByFew a = free.gram;
  a.diagonal() += prior.cwiseAbs2().cwiseInverse();
  const double determinant = invert(a);
  const FewValues ratio = a.lazyProduct(free.c);
  SetEvidence result;
  const NoiseDensity::Averages averages =
      noise.averages(std::max(free.ee - free.c.dot(ratio), 0.0));
  result.larger_noise = averages.larger_share;
  result.log_evidence =
      averages.log_density - 0.5 * log_det - 0.5 * std::log(determinant * prior.cwiseAbs2().prod());
  const double s = std::sqrt(averages.noise_square);
  for (const Index i : each_below(m)) {
    const double sigma = s * std::sqrt(a(i, i));
    // Farther beyond its range than noise explains, and not merely about null: the data need
    // another cause.
    const double slack = 2.0 * sigma;
    const double reach = free.refined[as_size(i)] ? 1.0 : 2.0;
    if (ratio(i) > reach * free.high(i) + slack ||
        (free.low(i) < 0.0 && ratio(i) < reach * free.low(i) - slack)) {
      result.log_evidence = kMinusInfinity;
      return result;
    }
    result.log_evidence += log_mass(ratio(i), sigma, free.low(i), free.high(i)) -
                           log_mass(0.0, s * prior(i), free.low(i), free.high(i));
  }
  return result;
}

}  // namespace

SetEvidence set_evidence(const NormalEquations& equations, const std::vector<Regressor>& regressors,
                         std::span<const Index> set, const NoiseDensity& noise) {
  const FreeEquations free = free_equations(equations, regressors, set);
  // If the kept rows do not depend on a cause they give no evidence for it.
  if (free.is_empty_column) return {kMinusInfinity, 0.0};
  SetEvidence wide = evidence_at(free, equations.log_det, noise, kWideSignalToNoise);
  if (free.c.size() == 0) return wide;
  const SetEvidence usual = evidence_at(free, equations.log_det, noise, kUsualSignalToNoise);
  wide.log_evidence = log_sum(std::log(1.0 - kWideSignalToNoisePrior) + usual.log_evidence,
                              std::log(kWideSignalToNoisePrior) + wide.log_evidence);
  return wide;
}

EvidenceBounds::EvidenceBounds(const NormalEquations& equations,
                               const std::vector<Regressor>& regressors, const NoiseDensity& noise)
    : equations_(equations),
      regressors_(regressors),
      noise_(noise),
      outside_(equations.ge.size(), std::ssize(kStrengthPriors)) {
  const double s = std::sqrt(noise.noise_square(equations.ee));
  for (const Index i : each_below(outside_.rows())) {
    const double unit = s / std::sqrt(equations.prior_square(i));
    for (const Index k : each_below(outside_.cols())) {
      const double sigma = unit * kStrengthPriors[as_size(k)].sigma;
      outside_(i, k) = regressor(i).fixed
                           ? 0.0
                           : -log_mass(0.0, sigma, regressor(i).lowest, regressor(i).highest);
    }
  }
}

ArrayXd EvidenceBounds::with_each(std::span<const Index> set) const {
  const MatrixXd& gg = equations_.gg;
  double fixed_left = equations_.ee;
  ArrayXd of_data = equations_.ge;
  for (const Index i : set) {
    if (!regressor(i).fixed) continue;
    fixed_left += gg(i, i) - 2.0 * of_data(i);
    of_data -= gg.col(i).array();
  }
  ArrayXd most = ArrayXd::Constant(of_data.size(), kMinusInfinity);
  for (const Index k : each_below(outside_.cols())) {
    const StrengthPrior& prior = kStrengthPriors[as_size(k)];
    const auto occam = [&](Index i, double square) {
      return outside_(i, k) -
             0.5 * std::log(square / equations_.prior_square(i) * prior.sigma * prior.sigma);
    };
    const ArrayXd precision = equations_.prior_square / (prior.sigma * prior.sigma);
    // The columns of the set's factor, of all rows.
    MatrixXd factor(of_data.size(), std::ssize(set));
    Index rank = 0;
    double quadratic = fixed_left;
    double log_weight = std::log(prior.share) - 0.5 * equations_.log_det;
    ArrayXd left = of_data;
    ArrayXd square = gg.diagonal();
    for (const Index i : set) {
      if (regressor(i).fixed) continue;
      VectorXd column = gg.col(i);
      for (const Index j : each_below(rank)) column -= factor(i, j) * factor.col(j);
      const double own = square(i) + precision(i);
      log_weight += occam(i, own);
      factor.col(rank) = column / std::sqrt(own);
      const double c = left(i) / std::sqrt(own);
      quadratic -= c * c;
      left -= c * factor.col(rank).array();
      square -= factor.col(rank).array().square();
      ++rank;
    }
    for (const Index i : each_below(most.size())) {
      double q = quadratic - 2.0 * left(i) + square(i);
      double own = log_weight;
      if (!regressor(i).fixed) {
        const double whole = square(i) + precision(i);
        q = quadratic - left(i) * left(i) / whole;
        own += occam(i, whole);
      }
      own += noise_.log_density(std::clamp(q, 0.0, equations_.ee));
      most(i) = log_sum(most(i), own);
    }
  }
  return most;
}

}  // namespace chaintrue::grid::diagnosis
