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
    root_ = VectorXd::Zero(residuals_.size());
    for (const auto u : each_index(problem.units())) {
      const SystemUnit& unit = problem.units()[u];
      root_.segment(unit.first_row, unit.rows).setConstant(std::sqrt(weights[as_index(u)]));
    }
  }

  struct Conditioned {
    VectorXd residual;
    MatrixXd covariance;
  };
  /// Residual and covariance of a unit.
  Conditioned conditioned(std::size_t unit) const {
    const Rows rows = rows_of({unit});
    if (auto held = held_out({unit})) return {*std::move(held), covariance(unit)};
    const auto rest = fit_without({unit});
    if (!rest) return {residuals_(rows), covariance(unit)};
    MatrixXd spread = linear::carried(problem_.design()(rows, Eigen::all), rest->covariance);
    spread.diagonal().array() += fit_.sigma2;
    return {against(*rest, rows), std::move(spread)};
  }

  /// Residuals of a group of units, unit by unit, all left out together.
  VectorXd residuals(const UnitGroup& group) const {
    if (auto held = held_out(group)) return *std::move(held);
    const auto rest = fit_without(group);
    return rest ? against(*rest, rows_of(group)) : VectorXd(residuals_(rows_of(group)));
  }

  /// Residual of a unit in the fit itself, with nothing left out.
  VectorXd residual_of(std::size_t unit) const {
    return problem_.units()[unit].segment(residuals_);
  }
  double distance(std::size_t unit) const {
    const VectorXd residual = held_out({unit}).value_or(residual_of(unit));
    return std::sqrt(residual.dot(linear::PivotedCholesky(covariance(unit)).solve(residual)));
  }

 private:
  Rows rows_of(const UnitGroup& group) const {
    Rows rows;
    for (const std::size_t unit : group) {
      const SystemUnit& own = problem_.units()[unit];
      for (const Index i : each_below(own.rows)) rows.push_back(own.first_row + i);
    }
    return rows;
  }

  /// r_out of (1); for units that do not count, r. Fails where the rows nearly determine their own
  /// prediction: then I - w X C X' / s^2 is rounding.
  tl::expected<VectorXd, interp::FitFailure> held_out(const UnitGroup& group) const {
    const Rows rows = rows_of(group);
    const VectorXd root = root_(rows), residual = residuals_(rows);
    return interp::held_out_residual(root.cwiseProduct(residual),
                                     linear::outer(root.asDiagonal() * by_root_(rows, Eigen::all)),
                                     fit_.sigma2)
        .map([&](const VectorXd& held) -> VectorXd {
          return (root.array() > 0.0).select(held.cwiseQuotient(root), residual);
        });
  }

  /// (1), whitened, the unit's noise at its full weight.
  MatrixXd covariance(std::size_t unit) const {
    const double weight = weights_[as_index(unit)];
    MatrixXd spread = linear::outer(by_root_(rows_of({unit}), Eigen::all));
    const MatrixXd noise = fit_.sigma2 * MatrixXd::Identity(spread.rows(), spread.rows());
    const linear::Cholesky kept(noise - weight * spread);
    if (kept.is_positive_definite()) spread = fit_.sigma2 * kept.solve(spread);
    return noise + spread;
  }

  /// The fit of the rest, with the smoothing of the whole.
  tl::expected<interp::PenalisedFit, interp::FitFailure> fit_without(const UnitGroup& group) const {
    VectorXd without = weights_;
    for (const std::size_t unit : group) without[as_index(unit)] = 0.0;
    return interp::fit_with_smoothing(weighted(problem_, without), fit_.lambda, fit_.sigma2);
  }
  VectorXd against(const interp::PenalisedFit& rest, const Rows& rows) const {
    return problem_.response()(rows) - problem_.design()(rows, Eigen::all) * rest.coefficients;
  }

  const JointProblem& problem_;
  const interp::PenalisedFit& fit_;
  const VectorXd& weights_;
  VectorXd residuals_;  ///< of all rows
  VectorXd root_;       ///< of their units' weights
  MatrixXd by_root_;    ///< X R of all units, C = R R'
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
