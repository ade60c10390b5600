// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Settings, sizes of causes and, where there is one, the model discrepancy, for one model of the
/// comparison; and the residual at every point, including held-out ones.
#pragma once

#include <vector>

#include "grid/diagnosis/model_comparison.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

struct Estimate {
  RegressorSet regressors;
  /// q, from the state of the system: settings in their units, the nuisances after them.
  VectorXd setting_change;
  VectorXd coefficient;  ///< for each regressor
  /// 0 if the size is a whole number; at a bound, the sigma from noise alone.
  VectorXd coefficient_sigma;
  double noise_square = 1.0;        ///< s^2
  VectorXd left;                    ///< n whitened rows, the discrepancy not taken out
  VectorXd left_given_discrepancy;  ///< the same with the discrepancy taken out
  Discrepancy discrepancy;
  VectorXd discrepancy_weights;  ///< N, one for each kept row; empty without a discrepancy
  /// Covariance of setting_change and of the free coefficients, in that order.
  MatrixXd covariance;
  Indices free;  ///< positions in `regressors`

  RegressorSet free_regressors() const;
  /// Index of one of the model's regressors in this estimate.
  Index position(int regressor) const;
};

/// The linear unknowns of a model: the settings, nuisances included, then the sizes of some regressors.
struct Unknowns {
  MatrixXd design;  ///< N x unknowns
  VectorXd sigma;   ///< of each beforehand
};
Unknowns unknowns_of(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                     const RegressorSet& free);

/// `regressors` and `discrepancy` as the model has them. A coefficient that would leave its bounds
/// stays at the bound.
Estimate estimate(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                  const RegressorSet& regressors, int discrepancy);

/// The kept rows' covariance with a discrepancy, factored once for all estimates given it.
struct DiscrepancyNoise {
  Discrepancy process;
  MatrixXd factor;          ///< s F, all rows
  LowRankNoise covariance;  ///< 1 + s^2 K
  bool is_of_process() const { return process.sigma_mm > 0.0; }
};
/// For -1 there is no process, only the noise.
DiscrepancyNoise discrepancy_noise(const RegressorSystem& system,
                                   const MarginalisedSystem& marginalised, int discrepancy);
Estimate estimate(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                  const RegressorSet& regressors, const DiscrepancyNoise& noise);

/// `left` with the nuisances' share added back: the machine's residual. For points `left` itself.
VectorXd left_of_machine(const RegressorSystem& system, const Estimate& estimate,
                         const VectorXd& left);

/// A unit's whitened residual in mm: a shift of the tool for chain readings; for a distance (excess
/// length, 0).
Vector2d error_of_unit(const RegressorSystem& system, const VectorXd& whitened, std::size_t unit);
std::vector<Vector2d> errors_of_units(const RegressorSystem& system, const VectorXd& whitened,
                                      const Indices& units);
/// Root mean square over the kept units in mm: of the tool where chains were read, of distances, or of one belt. `units`
/// empty: all units.
double rms_of_units_mm(const RegressorSystem& system, const KeptRows& kept,
                       const VectorXd& whitened, const Indices& units = {});
/// Its covariance with noise as stated.
Matrix2d noise_of_unit_mm2(const RegressorSystem& system, std::size_t unit);
/// Root mean square of that over some units.
double noise_of_units_mm(const RegressorSystem& system, const Indices& units);

/// A chain residual (read minus predicted) as an error of the tool [mm]: where it landed minus where the model has it.
Vector2d tool_shift(const SystemPlace& place, const Vector2d& chain_mm);

}  // namespace chaintrue::grid::diagnosis
