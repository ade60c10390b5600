// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/input_checks/robust_trend.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "grid/containers.hpp"
#include "grid/statistics.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::input_checks {
namespace {

/// No manual readings are finer; without a floor exact agreement has infinite density.
constexpr double kLeastScaleMm = 0.5;
/// EM gains a digit in some five steps here; the decision needs two.
constexpr int kSteps = 20;
/// A missing reading is uniform over a square, or a line, of this length.
constexpr double kAnywhereMm = 2000.0;

}  // namespace

double RobustTrend::median_residual_mm() const {
  std::vector<double> finite;
  for (const double one_mm : residual_mm) {
    if (std::isfinite(one_mm)) finite.push_back(one_mm);
  }
  return finite.empty() ? kInfinity : median(std::move(finite));
}

double log_density_of(double residual_mm, double scale_mm, Index components) {
  return -0.5 * as_double(components + 1) * std::log1p(std::pow(residual_mm / scale_mm, 2));
}

RobustTrend robust_trend(const TrendRows& rows, const VectorXd& prior_sigma_mm) {
  const MatrixXd& basis = rows.basis;
  const MatrixXd& readings_mm = rows.off_mm;
  const Index n = readings_mm.rows();
  const Index components = readings_mm.cols();
  const auto is_there = [&](Index i) {
    return readings_mm.row(i).allFinite() && basis.row(i).allFinite();
  };
  RobustTrend trend;
  trend.coefficients = MatrixXd::Zero(basis.cols(), components);
  trend.residual_mm = VectorXd::Constant(n, kInfinity);
  const auto take_residuals = [&] {
    for (const Index i : each_below(n)) {
      if (is_there(i))
        trend.residual_mm[i] = (readings_mm.row(i) - basis.row(i) * trend.coefficients).norm();
    }
  };
  take_residuals();
  const double start_mm = trend.median_residual_mm();
  trend.scale_mm = std::max(kLeastScaleMm, std::isfinite(start_mm) ? start_mm : kLeastScaleMm);
  const MatrixXd prior = prior_sigma_mm.cwiseAbs2().cwiseInverse().asDiagonal();
  const auto dof = as_double(components + 1);
  for (int step = 0; step < kSteps; ++step) {
    const double variance = trend.scale_mm * trend.scale_mm;
    MatrixXd normal = prior;
    MatrixXd right = MatrixXd::Zero(basis.cols(), components);
    double sum = 0.0;
    double count = 0.0;
    for (const Index i : each_below(n)) {
      if (!std::isfinite(trend.residual_mm[i])) continue;
      const double weight = dof / (1.0 + trend.residual_mm[i] * trend.residual_mm[i] / variance);
      normal.noalias() += weight / variance * basis.row(i).transpose() * basis.row(i);
      right.noalias() += weight / variance * basis.row(i).transpose() * readings_mm.row(i);
      sum += weight * trend.residual_mm[i] * trend.residual_mm[i];
      count += as_double(components);
    }
    if (count == 0.0) break;
    trend.coefficients = linear::PivotedCholesky(normal).solve(right);
    trend.scale_mm = std::max(kLeastScaleMm, std::sqrt(sum / count));
    take_residuals();
  }
  const double normaliser =
      components == 1 ? std::log(std::numbers::pi) : std::log(2.0 * std::numbers::pi);
  for (const double residual_mm : trend.residual_mm) {
    trend.log_likelihood += std::isfinite(residual_mm)
                                ? log_density_of(residual_mm, trend.scale_mm, components) -
                                      normaliser - as_double(components) * std::log(trend.scale_mm)
                                : -as_double(components) * std::log(kAnywhereMm);
  }
  trend.prior_chi_square =
      (prior_sigma_mm.cwiseInverse().asDiagonal() * trend.coefficients).squaredNorm();
  trend.log_likelihood -= 0.5 * trend.prior_chi_square;
  return trend;
}

}  // namespace chaintrue::grid::input_checks
