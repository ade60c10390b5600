// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Units and single readings compared with a fit without them. Private to grid/estimation.
///
/// With weights w, whitened rows X and residuals r of a unit, C the covariance of the unknowns and
/// s^2 the noise of a fit with the unit; without it
///
///   r_out = (I - w X C X' / s^2)^-1 r,   cov r_out = s^2 I + X C_out X'                        (1)
///   X C_out X' = s^2 (s^2 I - w X C X')^-1 X C X'
///
/// The distance is sqrt(r_out' (cov r_out)^-1 r_out).
#pragma once

#include <cmath>
#include <optional>
#include <stdexcept>
#include <vector>

#include "grid/containers.hpp"
#include "grid/estimation/joint_priors.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {

/// A fit of a problem with these weights. All must outlive this.
class LeftOut {
 public:
  LeftOut(const JointProblem& problem, const interp::PenalisedFit& fit, const VectorXd& weights)
      : problem_(problem),
        fit_(fit),
        weights_(weights),
        residuals_(problem.response() - problem.design() * fit.coefficients) {
    const linear::Cholesky factor(fit.covariance);
    // Positive up to rounding.
    by_root_ = linear::product(problem.design(), factor.is_positive_definite()
                                                     ? factor.lower()
                                                     : linear::covariance_root(fit.covariance));
  }

  struct Conditioned {
    VectorXd residual;
    MatrixXd covariance;
  };
  /// Residual and covariance of a unit. If the unit nearly determines its own prediction, I - w X C
  /// X' / s^2 is rounding: the rest is then fitted again with the smoothing of the whole.
  Conditioned conditioned(std::size_t unit) const {
    const auto at = as_index(unit);
    const bool by_formula =
        weights_[at] == 0.0 ||
        interp::held_out_residual(residual_of(unit), weights_[at] * spread_of(unit), fit_.sigma2);
    if (!by_formula) {
      if (const auto rest = fit_without({unit})) {
        const MatrixXd rows = rows_of(unit);
        Conditioned conditioned{response_of(unit) - rows * rest->coefficients,
                                linear::carried(rows, rest->covariance)};
        conditioned.covariance.diagonal().array() += fit_.sigma2;
        return conditioned;
      }
    }
    return {residual(unit), covariance(unit)};
  }

  /// The whitened left-out residual of a unit. Rejected readings are not in the fit.
  VectorXd residual(std::size_t unit) const {
    const double weight = weights_[as_index(unit)];
    VectorXd residual = residual_of(unit);
    if (weight == 0.0) return residual;
    const auto held = interp::held_out_residual(residual, weight * spread_of(unit), fit_.sigma2);
    return held ? *held : residual;
  }

  /// Residuals of a group of units, all left out together.
  std::vector<VectorXd> residuals(const UnitGroup& group) const {
    Rows rows;
    std::vector<double> roots;
    for (const std::size_t unit : group) {
      const double weight = weights_[as_index(unit)];
      if (weight == 0.0) continue;
      const SystemUnit& own = problem_.units()[unit];
      for (const Index i : each_below(own.rows)) {
        rows.push_back(own.first_row + i);
        roots.push_back(std::sqrt(weight));
      }
    }
    std::vector<VectorXd> residuals;
    if (rows.empty()) {
      for (const std::size_t unit : group) residuals.push_back(residual_of(unit));
      return residuals;
    }
    const Eigen::Map<const VectorXd> root(roots.data(), std::ssize(roots));
    const auto held = interp::held_out_residual(
        root.cwiseProduct(residuals_(rows)),
        linear::outer(root.asDiagonal() * by_root_(rows, Eigen::all)), fit_.sigma2);
    if (!held) {
      if (const auto rest = fit_without(group)) {
        for (const std::size_t unit : group)
          residuals.push_back(response_of(unit) - rows_of(unit) * rest->coefficients);
        return residuals;
      }
    }
    Index at = 0;
    for (const std::size_t unit : group) {
      const double weight = weights_[as_index(unit)];
      if (held && weight > 0.0) {
        const Index own = problem_.units()[unit].rows;
        residuals.emplace_back(held->segment(at, own) / std::sqrt(weight));
        at += own;
      } else {
        residuals.push_back(residual_of(unit));
      }
    }
    return residuals;
  }

  /// (1), whitened, the unit's noise at its full weight.
  MatrixXd covariance(std::size_t unit) const {
    const double weight = weights_[as_index(unit)];
    MatrixXd spread = spread_of(unit);
    const MatrixXd noise = fit_.sigma2 * MatrixXd::Identity(spread.rows(), spread.rows());
    if (weight > 0.0) {
      const linear::Cholesky kept(noise - weight * spread);
      if (kept.is_positive_definite()) spread = fit_.sigma2 * kept.solve(spread);
    }
    return noise + spread;
  }

  /// Residual of a unit in the fit itself, with nothing left out.
  VectorXd residual_of(std::size_t unit) const {
    return problem_.units()[unit].segment(residuals_);
  }
  double distance(std::size_t unit) const {
    const VectorXd residual = this->residual(unit);
    return std::sqrt(residual.dot(linear::PivotedCholesky(covariance(unit)).solve(residual)));
  }

 private:
  MatrixXd rows_of(std::size_t unit) const {
    const SystemUnit& own = problem_.units()[unit];
    return problem_.design().middleRows(own.first_row, own.rows);
  }

  /// The fit of the rest, with the smoothing of the whole; empty if there is none.
  std::optional<interp::PenalisedFit> fit_without(const UnitGroup& group) const {
    VectorXd without = weights_;
    for (const std::size_t unit : group) without[as_index(unit)] = 0.0;
    auto rest = interp::fit_with_smoothing(weighted(problem_, without), fit_.lambda, fit_.sigma2);
    return rest ? std::optional(*std::move(rest)) : std::nullopt;
  }

  /// X C X'.
  MatrixXd spread_of(std::size_t unit) const {
    const SystemUnit& own = problem_.units()[unit];
    const auto root = by_root_.middleRows(own.first_row, own.rows);
    return root.lazyProduct(root.transpose());
  }

  VectorXd response_of(std::size_t unit) const {
    return problem_.units()[unit].segment(problem_.response());
  }

  const JointProblem& problem_;
  const interp::PenalisedFit& fit_;
  const VectorXd& weights_;
  VectorXd residuals_;             ///< of all rows
  MatrixXd by_root_;               ///< X R of all units, C = R R'
};

/// Length that a vector of n standard normal numbers exceeds as seldom as one number exceeds z:
/// E. Wilson and M. Hilferty, The distribution of chi-square, Proc. Natl. Acad. Sci. 17 (1931) 684.
inline double chi(Index n, double z) {
  const double part = 2.0 / (9.0 * as_double(n));
  return std::sqrt(as_double(n) * std::pow(1.0 - part + z * std::sqrt(part), 3));
}

/// The treatment of a unit by its distance.
struct UnitRule {
  double full_weight_within;  ///< 95 % of good units
  double rejected_beyond;
  bool worst_first;  ///< one at a time, against the others' prediction and noise
};

inline UnitRule rule_of(Index rows) {
  if (rows == 1) return {1.96, kBadDistanceSigmas, true};
  if (rows == 2) return {2.4477, kBadPointDistance, false};
  // The same probabilities as for two rows: 5 % and 4e-5.
  return {chi(rows, 1.6449), chi(rows, 3.9444), false};
}

/// A reading and the number of its unit in the problem.
struct Shift : ReadingShift {
  observation::UnitReading at;
};
/// Among the rejected readings, or among the others.
inline std::vector<Shift> shifts(const JointProblem& problem, const interp::PenalisedFit& fit,
                                 bool of_rejected) {
  std::vector<Shift> all;
  const VectorXd residual = problem.response() - problem.design() * fit.coefficients;
  const FittedRows rows{problem.design(), residual, fit, problem.dof(fit)};
  for (const auto u : each_index(problem.units())) {
    const SystemUnit& unit = problem.units()[u];
    const Rows& rejected = problem.rejected(u);
    Rows readings = rejected;
    if (!of_rejected) {
      readings = numbers_below<Index>(unit.by_reading.cols());
      std::erase_if(readings, [&](Index i) { return contains(rejected, i); });
    }
    for (const Index i : readings) all.push_back({shift_of(rows, unit, rejected, i), {u, i}});
  }
  return all;
}

}  // namespace chaintrue::grid::estimation
