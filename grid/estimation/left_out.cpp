// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/left_out.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace chaintrue::grid::estimation {
namespace {

/// Length that a vector of n standard normal numbers exceeds as seldom as one number exceeds z:
/// E. Wilson and M. Hilferty, The distribution of chi-square, Proc. Natl. Acad. Sci. 17 (1931) 684.
double chi(Eigen::Index n, double z) {
  const double part = 2.0 / (9.0 * static_cast<double>(n));
  return std::sqrt(static_cast<double>(n) * std::pow(1.0 - part + z * std::sqrt(part), 3));
}

}  // namespace

UnitRule rule_of(Eigen::Index rows) {
  if (rows == 1) return {1.96, kBadDistanceSigmas, true};
  if (rows == 2) return {2.4477, kBadPointDistance, false};
  // The same chances as of two rows: 5 % and 4e-5.
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

std::vector<Eigen::VectorXd> LeftOut::residuals(const UnitGroup& group) const {
  Eigen::Index rows = 0;
  for (const std::size_t unit : group) {
    if (weights_[static_cast<Eigen::Index>(unit)] > 0.0) rows += problem_.units()[unit].rows;
  }
  Eigen::MatrixXd design(rows, problem_.unknowns().total());
  Eigen::VectorXd response(rows);
  rows = 0;
  for (const std::size_t unit : group) {
    const double weight = weights_[static_cast<Eigen::Index>(unit)];
    if (weight == 0.0) continue;
    const double root = std::sqrt(weight);
    const Eigen::Index count = problem_.units()[unit].rows;
    design.middleRows(rows, count) = root * rows_of(unit);
    response.segment(rows, count) = root * response_of(unit);
    rows += count;
  }
  const auto held = rows == 0 ? tl::expected<interp::HeldOut, interp::FitFailure>(interp::HeldOut{})
                              : fit_.held_out(design, response);
  std::vector<Eigen::VectorXd> residuals;
  Eigen::Index at = 0;
  for (const std::size_t unit : group) {
    const double weight = weights_[static_cast<Eigen::Index>(unit)];
    if (held && weight > 0.0) {
      const Eigen::Index count = problem_.units()[unit].rows;
      residuals.emplace_back(held->residual.segment(at, count) / std::sqrt(weight));
      at += count;
    } else {
      residuals.emplace_back(response_of(unit) - rows_of(unit) * fit_.coefficients);
    }
  }
  return residuals;
}

Eigen::MatrixXd LeftOut::covariance(std::size_t unit) const {
  const Eigen::MatrixXd design = rows_of(unit);
  const double weight = weights_[static_cast<Eigen::Index>(unit)];
  Eigen::MatrixXd spread = design * fit_.covariance * design.transpose();
  const Eigen::MatrixXd noise =
      fit_.sigma2 * Eigen::MatrixXd::Identity(design.rows(), design.rows());
  if (weight > 0.0) {
    const Eigen::MatrixXd kept = noise - weight * spread;
    const Eigen::LLT<Eigen::MatrixXd> factor(kept);
    if (factor.info() == Eigen::Success) spread = noise * factor.solve(spread);
  }
  return noise + spread;
}

double LeftOut::distance(std::size_t unit) const {
  const Eigen::VectorXd residual = residuals({unit}).front();
  return std::sqrt(residual.dot(covariance(unit).ldlt().solve(residual)));
}

}  // namespace chaintrue::grid::estimation
