// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/left_out.hpp"

#include <cmath>
#include <stdexcept>

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {
namespace {

/// Length that a vector of n standard normal numbers exceeds as seldom as one number exceeds z:
/// E. Wilson and M. Hilferty, The distribution of chi-square, Proc. Natl. Acad. Sci. 17 (1931) 684.
double chi(Eigen::Index n, double z) {
  const double part = 2.0 / (9.0 * as_double(n));
  return std::sqrt(as_double(n) * std::pow(1.0 - part + z * std::sqrt(part), 3));
}

}  // namespace

UnitRule rule_of(Eigen::Index rows) {
  if (rows == 1) return {1.96, kBadDistanceSigmas, true};
  if (rows == 2) return {2.4477, kBadPointDistance, false};
  // The same probabilities as for two rows: 5 % and 4e-5.
  return {chi(rows, 1.6449), chi(rows, 3.9444), false};
}

Eigen::MatrixXd LeftOut::rows_of(std::size_t unit) const {
  const SystemUnit& own = problem_.units()[unit];
  return problem_.design().middleRows(own.first_row, own.rows);
}

Eigen::VectorXd LeftOut::response_of(std::size_t unit) const {
  const SystemUnit& own = problem_.units()[unit];
  return problem_.response().segment(own.first_row, own.rows);
}

void LeftOut::prepare_units() {
  if (problem_.local() == nullptr) {
    prepare_all();
    return;
  }
  spreads_ = problem_.local()->spreads(fit_.covariance);
  residuals_ = problem_.response() - problem_.design() * fit_.coefficients;
}

void LeftOut::prepare_all() {
  if (by_root_.size() > 0) return;
  const linear::Cholesky factor(fit_.covariance);
  // Positive up to rounding.
  by_root_ = linear::product(problem_.design(),
                             factor.is_positive_definite()
                                 ? factor.lower()
                                 : linear::covariance_root(fit_.covariance));
}

Eigen::MatrixXd LeftOut::spread_of(std::size_t unit) const {
  if (!spreads_.empty()) return spreads_[unit];
  if (by_root_.size() == 0) {
    const Eigen::MatrixXd design = rows_of(unit);
    return linear::carried(design, fit_.covariance);
  }
  const SystemUnit& own = problem_.units()[unit];
  const auto root = by_root_.middleRows(own.first_row, own.rows);
  return root.lazyProduct(root.transpose());
}

Eigen::VectorXd LeftOut::residual_of(std::size_t unit) const {
  if (residuals_.size() > 0) {
    const SystemUnit& own = problem_.units()[unit];
    return residuals_.segment(own.first_row, own.rows);
  }
  return response_of(unit) - rows_of(unit) * fit_.coefficients;
}

std::optional<interp::PenalisedFit> LeftOut::fit_without(const UnitGroup& group) const {
  Eigen::VectorXd without = weights_;
  for (const std::size_t unit : group) without[as_index(unit)] = 0.0;
  auto rest = interp::fit_with_smoothing(problem_.weighted(without), fit_.lambda, fit_.sigma2);
  return rest ? std::optional(*std::move(rest)) : std::nullopt;
}

LeftOut::Conditioned LeftOut::conditioned(std::size_t unit) const {
  const auto at = as_index(unit);
  const bool by_formula =
      weights_[at] == 0.0 ||
      interp::held_out_residual(residual_of(unit), weights_[at] * spread_of(unit), fit_.sigma2);
  if (!by_formula) {
    if (const auto rest = fit_without({unit})) {
      const Eigen::MatrixXd rows = rows_of(unit);
      Conditioned conditioned{response_of(unit) - rows * rest->coefficients,
                linear::carried(rows, rest->covariance)};
      conditioned.covariance.diagonal().array() += fit_.sigma2;
      return conditioned;
    }
  }
  return {residual(unit), covariance(unit)};
}

Eigen::VectorXd LeftOut::residual(std::size_t unit) const {
  const double weight = weights_[as_index(unit)];
  Eigen::VectorXd residual = residual_of(unit);
  if (weight == 0.0) return residual;
  const auto held = interp::held_out_residual(residual, weight * spread_of(unit), fit_.sigma2);
  return held ? *held : residual;
}

std::vector<Eigen::VectorXd> LeftOut::residuals(const UnitGroup& group) const {
  if (by_root_.size() == 0) throw std::logic_error("groups left out before all was prepared");
  std::vector<Eigen::Index> rows;
  std::vector<double> roots;
  for (const std::size_t unit : group) {
    const double weight = weights_[as_index(unit)];
    if (weight == 0.0) continue;
    const SystemUnit& own = problem_.units()[unit];
    for (Eigen::Index i = 0; i < own.rows; ++i) {
      rows.push_back(own.first_row + i);
      roots.push_back(std::sqrt(weight));
    }
  }
  std::vector<Eigen::VectorXd> residuals;
  if (rows.empty()) {
    for (const std::size_t unit : group) residuals.push_back(residual_of(unit));
    return residuals;
  }
  const auto count = std::ssize(rows);
  const Eigen::Map<const Eigen::VectorXd> root(roots.data(), count);
  Eigen::VectorXd residual(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = rows[as_size(i)];
    residual[i] =
        root[i] * (problem_.response()[row] - problem_.design().row(row).dot(fit_.coefficients));
  }
  const auto held = interp::held_out_residual_by_root(
      residual, root.asDiagonal() * by_root_(rows, Eigen::all), fit_.sigma2);
  if (!held) {
    if (const auto rest = fit_without(group)) {
      for (const std::size_t unit : group)
        residuals.push_back(response_of(unit) - rows_of(unit) * rest->coefficients);
      return residuals;
    }
  }
  Eigen::Index at = 0;
  for (const std::size_t unit : group) {
    const double weight = weights_[as_index(unit)];
    if (held && weight > 0.0) {
      const Eigen::Index own = problem_.units()[unit].rows;
      residuals.emplace_back(held->segment(at, own) / std::sqrt(weight));
      at += own;
    } else {
      residuals.push_back(residual_of(unit));
    }
  }
  return residuals;
}

Eigen::MatrixXd LeftOut::covariance(std::size_t unit) const {
  const double weight = weights_[as_index(unit)];
  Eigen::MatrixXd spread = spread_of(unit);
  const Eigen::MatrixXd noise =
      fit_.sigma2 * Eigen::MatrixXd::Identity(spread.rows(), spread.rows());
  if (weight > 0.0) {
    const linear::Cholesky kept(noise - weight * spread);
    if (kept.is_positive_definite()) spread = fit_.sigma2 * kept.solve(spread);
  }
  return noise + spread;
}

double LeftOut::distance(std::size_t unit) const {
  const Eigen::VectorXd residual = this->residual(unit);
  return std::sqrt(residual.dot(linear::PivotedCholesky(covariance(unit)).solve(residual)));
}

}  // namespace chaintrue::grid::estimation
