// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Units compared with a fit without them, and the resulting weights. Private to grid/estimation.
///
/// With weights w, whitened rows X and residuals r of a unit, C the covariance of the unknowns and
/// s^2 the noise of a fit with the unit; without it
///
///   r_out = (I - w X C X' / s^2)^-1 r,   cov r_out = s^2 I + X C_out X'                        (1)
///   X C_out X' = s^2 (s^2 I - w X C X')^-1 X C X'
///
/// The distance is sqrt(r_out' (cov r_out)^-1 r_out).
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/estimation/joint_problem.hpp"

namespace chaintrue::grid::estimation {

/// A fit of a problem with these weights. All must outlive this.
class LeftOut {
 public:
  LeftOut(const JointProblem& problem,
          const interp::PenalisedFit& fit,
          const Eigen::VectorXd& weights)
      : problem_(problem), fit_(fit), weights_(weights) {}
  /// Call first if all units are needed: X C X' of all takes a fraction of the time.
  void prepare_units();
  /// Likewise for groups.
  void prepare_all();

  struct Conditioned {
    Eigen::VectorXd residual;
    Eigen::MatrixXd covariance;
  };
  /// Residual and covariance of a unit. If the unit nearly determines its own prediction, I - w X C
  /// X' / s^2 is rounding: the rest is then fitted again with the smoothing of the whole.
  [[nodiscard]] Conditioned conditioned(std::size_t unit) const;
  /// The whitened left-out residual of a unit. Rejected readings are not in the fit.
  [[nodiscard]] Eigen::VectorXd residual(std::size_t unit) const;
  /// Those of a group of units with all of them left out. \throws std::logic_error before
  /// prepare_all().
  [[nodiscard]] std::vector<Eigen::VectorXd> residuals(const UnitGroup& group) const;
  /// (1), whitened, the unit's noise at its full weight.
  [[nodiscard]] Eigen::MatrixXd covariance(std::size_t unit) const;
  [[nodiscard]] double distance(std::size_t unit) const;

 private:
  [[nodiscard]] Eigen::MatrixXd rows_of(std::size_t unit) const;
  /// The fit of the rest, with the smoothing of the whole; empty if there is none.
  [[nodiscard]] std::optional<interp::PenalisedFit> fit_without(const UnitGroup& group) const;
  /// X C X'.
  [[nodiscard]] Eigen::MatrixXd spread_of(std::size_t unit) const;
  [[nodiscard]] Eigen::VectorXd residual_of(std::size_t unit) const;
  [[nodiscard]] Eigen::VectorXd response_of(std::size_t unit) const;

  const JointProblem& problem_;
  const interp::PenalisedFit& fit_;
  const Eigen::VectorXd& weights_;
  std::vector<Eigen::MatrixXd> spreads_;  ///< X C X' of each unit, where the design is local
  Eigen::VectorXd residuals_;             ///< there, of all rows
  Eigen::MatrixXd by_root_;  ///< X R of all units, C = R R'; empty before prepare_all()
};

/// The treatment of a unit by its distance.
struct UnitRule {
  double full_weight_within;  ///< 95 % of good units
  double rejected_beyond;
  bool worst_first;  ///< one at a time, against the others' prediction and noise
};
[[nodiscard]] UnitRule rule_of(Eigen::Index rows);

}  // namespace chaintrue::grid::estimation
