// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/evidence.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "grid/diagnosis/normal.hpp"

namespace chaintrue::grid::diagnosis {
namespace {

constexpr double kMinusInfinity = -std::numeric_limits<double>::infinity();

double log_sum(double a, double b) {
  const double high = std::max(a, b);
  return high == kMinusInfinity ? high : high + std::log1p(std::exp(std::min(a, b) - high));
}

/// log of the chance that a normal lies in [low, high].
double log_mass(double mean, double sigma, double low, double high) {
  return log_normal_mass((low - mean) / sigma, (high - mean) / sigma);
}

/// L^-1 W K W' L^-T for a pattern of 1 mm.
Eigen::MatrixXd reduced_pattern(const Rows& rows,
                                const Session& session,
                                const Space& space,
                                const PatternShape& shape) {
  Eigen::MatrixXd c = pattern_covariance(session, rows, space.kept, shape);
  const auto lower = space.factor.triangularView<Eigen::Lower>();
  c = lower.solve(c).eval();
  return lower.solve(c.transpose()).eval();
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

double NoiseDensity::log_density(double quadratic) const {
  double sum = std::log(1.0 - kLargerNoisePrior) + part(1.0, quadratic);
  for (const double scale : kLargerNoise) {
    sum = log_sum(sum,
                  std::log(kLargerNoisePrior / std::size(kLargerNoise)) + part(scale, quadratic));
  }
  return sum;
}

double NoiseDensity::larger_share(double quadratic) const {
  const double stated = std::log(1.0 - kLargerNoisePrior) + part(1.0, quadratic);
  return 1.0 - std::exp(stated - log_density(quadratic));
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

double log_price_of_bad(const Rows& rows) {
  return std::log(kBadPointPrior) -
         0.5 * static_cast<double>(rows.unit_rows) *
             std::log(2.0 * std::numbers::pi * kBadPointSpread * kBadPointSpread);
}

Space make_space(const Rows& rows, const std::vector<bool>& bad, const Steps& steps) {
  Space space;
  space.bad = bad;
  for (Eigen::Index row = 0; row < rows.e.size(); ++row) {
    const auto unit = static_cast<std::size_t>(row / rows.unit_rows);
    if (unit >= bad.size() || !bad[unit]) space.kept.push_back(row);
  }
  const auto set_aside = static_cast<double>(std::count(bad.begin(), bad.end(), true));
  space.log_bad = set_aside * log_price_of_bad(rows);
  const Eigen::MatrixXd a = rows.by_setting(space.kept, Eigen::all);
  Eigen::MatrixXd v = Eigen::MatrixXd::Identity(a.rows(), a.rows());
  if (steps.project_settings) {
    const Eigen::MatrixXd scaled = a * rows.sigma.asDiagonal();
    v += scaled * scaled.transpose();
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(v);
  space.factor = llt.matrixL();
  space.log_det = 2.0 * space.factor.diagonal().array().log().sum();
  const auto lower = space.factor.triangularView<Eigen::Lower>();
  space.e = rows.e(space.kept);
  if (steps.project_settings) space.e -= a * rows.expected_change;
  lower.solveInPlace(space.e);
  space.g = rows.g(space.kept, Eigen::all);
  // Eigen's solver reads past an empty right side.
  if (space.g.cols() > 0) lower.solveInPlace(space.g);
  return space;
}

Eigen::LLT<Eigen::MatrixXd> nuisance_noise(const Rows& rows,
                                           const std::vector<Eigen::Index>& kept) {
  if (rows.nuisances == 0) return {};
  const Eigen::MatrixXd scaled =
      nuisance_columns(rows)(kept, Eigen::all) * rows.sigma.tail(rows.nuisances).asDiagonal();
  Eigen::MatrixXd covariance = scaled * scaled.transpose();
  covariance.diagonal().array() += 1.0;
  return Eigen::LLT<Eigen::MatrixXd>(covariance);
}

double square_in_noise(const Rows& rows,
                       const std::vector<Eigen::Index>& kept,
                       const Eigen::VectorXd& column) {
  Eigen::VectorXd own = column(kept);
  if (rows.nuisances > 0) nuisance_noise(rows, kept).matrixL().solveInPlace(own);
  return own.squaredNorm();
}

double length_in_noise(const Rows& rows,
                       const std::vector<Eigen::Index>& kept,
                       const Eigen::VectorXd& column) {
  return std::sqrt(square_in_noise(rows, kept, column));
}

Eigen::VectorXd reduced(const Space& space, const Eigen::VectorXd& column) {
  Eigen::VectorXd result = column(space.kept);
  space.factor.triangularView<Eigen::Lower>().solveInPlace(result);
  return result;
}

Eigen::Index Metric::position(int column) const {
  const auto found = std::lower_bound(columns.begin(), columns.end(), column);
  return static_cast<Eigen::Index>(found - columns.begin());
}

Metric plain_metric(const Space& space, std::vector<int> columns) {
  Metric metric;
  std::sort(columns.begin(), columns.end());
  metric.columns = std::move(columns);
  const Eigen::MatrixXd g = space.g(Eigen::all, metric.columns);
  metric.ee = space.e.squaredNorm();
  metric.ge = g.transpose() * space.e;
  metric.gg = g.transpose() * g;
  metric.log_det = space.log_det;
  return metric;
}

std::vector<Metric> pattern_metrics(const Rows& rows,
                                    const Session& session,
                                    Space& space,
                                    const std::vector<int>& columns) {
  std::vector<int> sorted = columns;
  std::sort(sorted.begin(), sorted.end());
  std::vector<Metric> metrics;
  space.pattern_trace.clear();
  for (const PatternShape& shape : kPatternShapes) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(
        reduced_pattern(rows, session, space, shape));
    const Eigen::ArrayXd values = eigen.eigenvalues().array().max(0.0);
    space.pattern_trace.push_back(values.sum());
    const Eigen::VectorXd e = eigen.eigenvectors().transpose() * space.e;
    const Eigen::MatrixXd g = eigen.eigenvectors().transpose() * space.g(Eigen::all, sorted).eval();
    for (const double delta : kPatternDeltas) {
      const Eigen::ArrayXd variance = 1.0 + values * (delta * delta / values.sum());
      const Eigen::VectorXd weight = variance.inverse();
      Metric metric;
      metric.columns = sorted;
      metric.ee = e.cwiseProduct(weight).dot(e);
      metric.ge = g.transpose() * weight.cwiseProduct(e);
      metric.gg = g.transpose() * weight.asDiagonal() * g;
      metric.log_det = space.log_det + variance.log().sum();
      metrics.push_back(std::move(metric));
    }
  }
  return metrics;
}

Pattern pattern_of(const Space& space, int index) {
  const auto deltas = static_cast<int>(std::size(kPatternDeltas));
  const int shape = index / deltas;
  const double trace = space.pattern_trace.at(static_cast<std::size_t>(shape));
  return {kPatternShapes[shape], kPatternDeltas[index % deltas] / std::sqrt(trace)};
}

namespace {

/// Set evidence for one sigma of delta.
SetEvidence evidence_at(const Metric& metric,
                        const std::vector<Direction>& directions,
                        std::span<const Eigen::Index> set,
                        const NoiseDensity& noise,
                        double delta_sigma) {
  SetEvidence result;
  std::vector<Eigen::Index> free;
  const auto direction = [&](Eigen::Index i) -> const Direction& {
    return directions[static_cast<std::size_t>(metric.columns[static_cast<std::size_t>(i)])];
  };
  double q = metric.ee;
  for (const Eigen::Index i : set) {
    if (!direction(i).fixed) {
      free.push_back(i);
      continue;
    }
    q -= 2.0 * metric.ge(i);
    for (const Eigen::Index j : set) {
      if (direction(j).fixed) q += metric.gg(i, j);
    }
  }
  const auto m = static_cast<Eigen::Index>(free.size());
  Eigen::VectorXd c(m);
  Eigen::VectorXd length(m);
  Eigen::MatrixXd a(m, m);
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index at = free[static_cast<std::size_t>(i)];
    length(i) = std::sqrt(metric.gg(at, at));
    c(i) = metric.ge(at);
    for (const Eigen::Index j : set) {
      if (direction(j).fixed) c(i) -= metric.gg(at, j);
    }
    c(i) /= length(i);
    for (Eigen::Index j = 0; j <= i; ++j) {
      a(i, j) = a(j, i) =
          metric.gg(at, free[static_cast<std::size_t>(j)]) / (length(i) * length(j));
    }
    a(i, i) += 1.0 / (delta_sigma * delta_sigma);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(a);
  result.delta = llt.solve(c);
  result.quadratic = std::max(q - c.dot(result.delta), 0.0);
  result.delta_square = llt.solve(Eigen::MatrixXd::Identity(m, m)).diagonal();
  const double half_log_det = Eigen::MatrixXd(llt.matrixL()).diagonal().array().log().sum();
  result.log_evidence = noise.log_density(result.quadratic) - 0.5 * metric.log_det - half_log_det -
                        static_cast<double>(m) * std::log(delta_sigma);
  const double s = std::sqrt(noise.noise_square(result.quadratic));
  for (Eigen::Index i = 0; i < m; ++i) {
    const Direction& own = direction(free[static_cast<std::size_t>(i)]);
    const double low = own.lowest * length(i);
    const double high = own.highest * length(i);
    // Further beyond what it may be than noise takes it, and not merely about null: the data ask
    // for something else.
    const double slack = 2.0 * s * std::sqrt(result.delta_square(i));
    const double reach = own.refined ? 1.0 : 2.0;
    if (result.delta(i) > reach * high + slack ||
        (low < 0.0 && result.delta(i) < reach * low - slack)) {
      result.log_evidence = kMinusInfinity;
      return result;
    }
    result.log_evidence +=
        log_mass(result.delta(i), s * std::sqrt(result.delta_square(i)), low, high) -
        log_mass(0.0, s * delta_sigma, low, high);
  }
  return result;
}

}  // namespace

SetEvidence set_evidence(const Metric& metric,
                         const std::vector<Direction>& directions,
                         std::span<const Eigen::Index> set,
                         const NoiseDensity& noise) {
  SetEvidence wide = evidence_at(metric, directions, set, noise, kWideDelta);
  const bool all_fixed = wide.delta.size() == 0;
  if (all_fixed) return wide;
  const SetEvidence usual = evidence_at(metric, directions, set, noise, kUsualDelta);
  wide.log_evidence = log_sum(std::log(1.0 - kWideDeltaPrior) + usual.log_evidence,
                              std::log(kWideDeltaPrior) + wide.log_evidence);
  return wide;
}

}  // namespace chaintrue::grid::diagnosis
