// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The evidence for a set of causes: the probability of these data if exactly those act,
/// marginalised over their sizes, the settings and the noise.
///
/// Notation
///   e, g_k   whitened rows (regressor_system.hpp), without those of rejected points
///   N        how many rows are kept
///   V        I + A diag(sigma^2) A': their covariance, with the settings unknown except for their
///            stated sigmas, in units of the noise's square.  e <- V^-1/2 (e - A (stated - value))
///   delta_k  coefficient times |V^-1/2 g_k|: the signal-to-noise ratio of a cause. Beforehand
///            N(0, kUsualSignalToNoise^2), with a small weight N(0, kWideSignalToNoise^2), cut to
///            what the parameter may be; the same size whatever else acts
///   s^2      the noise's square over the stated one: scaled inverse chi^2, dof as stated, about 1;
///            with a small weight about one of kLargerNoise squared
///   K        covariance of the model discrepancy (discrepancy.hpp)
///
/// With conjugate priors all integrals are closed but for the cut, which is the mass of the
/// posterior inside the bounds over that of the prior (exact for one cause).
///
/// Sources: A. O'Hagan and J. Forster, Bayesian Inference (2004), section 11.3, for the linear
/// model; C. Rasmussen and C. Williams, Gaussian Processes (2006), section 2.7, for linear terms
/// with a process.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <vector>

#include "grid/diagnosis/covariance_root.hpp"
#include "grid/diagnosis/discrepancy.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid::diagnosis {

/// The data's density as a function of their quadratic form, the noise averaged out: over the noise as stated and over
/// each of kLargerNoise.
class NoiseDensity {
 public:
  NoiseDensity(double dof, Index rows);

  struct Averages {
    double log_density = 0.0;
    double noise_square = 0.0;  ///< expected s^2
    double larger_share = 0.0;  ///< share of the density from noise larger than stated
  };
  Averages averages(double quadratic) const;

  double log_density(double quadratic) const { return averages(quadratic).log_density; }
  /// The part of it from noise as stated.
  double log_density_as_stated(double quadratic) const;
  double noise_square(double quadratic) const { return averages(quadratic).noise_square; }

 private:
  struct Component {
    double anchor = 0.0;    ///< dof times the square of its scale
    double constant = 0.0;  ///< log density without the quadratic form, with the prior of the scale
  };
  double part(const Component& component, double quadratic) const;

  double dof_;
  double rows_;
  /// Noise as stated first.
  std::array<Component, 1 + std::tuple_size_v<decltype(kLargerNoise)>> components_;
};

/// The system with the settings integrated out and some points rejected.
struct MarginalisedSystem {
  Flags outliers;             ///< a flag for each outlier group
  KeptRows kept;              ///< N rows
  CovarianceRoot root;        ///< N x N, R of V = R R
  VectorXd e;                 ///< N, R^-1 times the residual
  double log_det = 0.0;       ///< log |V|
  double log_outliers = 0.0;  ///< prior and density of the rejected points
  /// Per kernel: trace of its covariance in this marginalised system, for a discrepancy of 1 mm.
  std::vector<double> discrepancy_trace;
};
/// Natural logarithm of the prior times the density of one rejected unit with this many rows.
double log_price_of_outlier(Index rows);
/// For all these groups. Each direction is a separate slip, and a unit has at most as many as rows.
double log_price_of_outliers(const RegressorSystem& system, const Flags& outliers);
MarginalisedSystem marginalise(const RegressorSystem& system, const Flags& outliers);
/// Applies R^-1 to columns that have all rows.
template <class M>
linear::Like<M> reduced(const MarginalisedSystem& marginalised, const M& columns) {
  return marginalised.root.solve(marginalised.kept(columns));
}
/// Inner products of every regressor's reduced column with those of a matrix, or with a vector.
/// With hundreds of visits these columns are the largest matrix of all, so they are never made.
template <class M>
linear::Like<M> with_regressors(const RegressorSystem& system,
                                const MarginalisedSystem& marginalised, const M& columns) {
  return system.g.transpose_times(marginalised.kept.spread(marginalised.root.solve(columns)));
}
/// The squared length of every regressor's reduced column.
VectorXd squared_lengths(const RegressorSystem& system, const MarginalisedSystem& marginalised);
/// The kept rows' covariance with the nuisances unknown except for their sigmas: the noise as it
/// appears in the readings.
LowRankNoise nuisance_noise(const RegressorSystem& system, const KeptRows& kept);
/// Length of a column's kept rows in units of that noise.
double length_in_noise(const RegressorSystem& system, const KeptRows& kept, const VectorXd& column);
/// The rows after subtracting these columns with the amplitudes that the kept rows give them.
VectorXd left_by(const KeptRows& kept, const MatrixXd& columns, const VectorXd& sigma,
                 VectorXd rows);
/// One sigma of a regressor's coefficient under the wide prior of its size.
double wide_coefficient_sigma(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                              int regressor);

/// |cosine| of two whitened signatures by their inner product and the product of their lengths; 0 if one
/// of them is zero.
inline double collinearity_of(double product, double lengths) {
  // Visible signatures are several sigmas long.
  constexpr double kNothing = 1e-12;
  return lengths > kNothing ? std::min(1.0, std::abs(product) / lengths) : 0.0;
}

/// Inner products of the residual and of some columns.
struct NormalEquations {
  RegressorSet columns;  ///< m regressors, ascending
  /// N x (1 + m): the residual and the columns; empty given a discrepancy or without some rows.
  MatrixXd rows;
  double ee = 0.0;  ///< e'e
  VectorXd ge;      ///< m, g'e
  MatrixXd gg;      ///< m x m, g'g
  /// m: the unit of the prior of a size. It is g'g without a discrepancy or, if the prior is on the
  /// size itself (Regressor::coefficient_sigma) the square at which that is kUsualSignalToNoise.
  VectorXd prior_square;
  double log_det = 0.0;  ///< of V and the discrepancy, without the noise's scale
  /// Returns the positions of some of the columns.
  ColumnSet positions(const RegressorSet& some) const;
};
/// NormalEquations::prior_square of columns with these squares.
VectorXd prior_squares(const std::vector<Regressor>& regressors, const RegressorSet& columns,
                       VectorXd squares);
NormalEquations normal_equations(const RegressorSystem& system,
                                 const MarginalisedSystem& marginalised, RegressorSet columns);
/// The same for columns that are reduced already.
NormalEquations normal_equations(const std::vector<Regressor>& regressors,
                                 const MarginalisedSystem& marginalised, RegressorSet columns,
                                 const MatrixXd& reduced_columns);

/// Kernel and size of a discrepancy, in a marginalised system.
Discrepancy discrepancy_of(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                           int discrepancy);

/// s F of a discrepancy (discrepancy_factor) in all rows; no columns for none.
MatrixXd discrepancy_columns(const RegressorSystem& system, const MarginalisedSystem& marginalised,
                             int discrepancy);

/// Priors of a signal-to-noise ratio: the usual one, and the wide one.
struct StrengthPrior {
  double sigma = 0.0;
  double share = 0.0;
};
inline constexpr std::array<StrengthPrior, 2> kStrengthPriors = {
    {{kUsualSignalToNoise, 1.0 - kWideSignalToNoisePrior},
     {kWideSignalToNoise, kWideSignalToNoisePrior}}};

/// Bounds the memory of a set's factorisation, which is allocated on the stack: twice the causes that a comparison takes.
inline constexpr int kMostFreeRegressors = 8;

/// A set of regressors fitted to the data.
struct SetEvidence {
  double log_evidence = 0.0;  ///< natural logarithm, up to a constant of the data
  double larger_noise = 0.0;  ///< share of it from noise larger than stated
};
/// `set` holds positions in the normal equations. Minus infinity if a cause would have to leave its
/// range. Throws std::length_error for more than kMostFreeRegressors that are not fixed.
SetEvidence set_evidence(const NormalEquations& equations, const std::vector<Regressor>& regressors,
                         std::span<const Index> set, const NoiseDensity& noise);

/// Upper bounds of log_evidence for sets with one more column, at the cost of an inner product each.
///
/// Without the mass of the posterior inside the bounds, which is at most one; over that of the prior for the largest
/// noise that a set can leave. Beyond the residual of nothing the density falls faster with the
/// noise than that grows.
class EvidenceBounds {
 public:
  /// All references must outlive this.
  EvidenceBounds(const NormalEquations& equations, const std::vector<Regressor>& regressors,
                 const NoiseDensity& noise);
  /// For each column, added to this set.
  [[nodiscard]] ArrayXd with_each(std::span<const Index> set) const;

 private:
  const Regressor& regressor(Index i) const {
    return regressors_[as_size(equations_.columns[as_size(i)])];
  }
  const NormalEquations& equations_;
  const std::vector<Regressor>& regressors_;
  const NoiseDensity& noise_;
  Eigen::ArrayXXd outside_;  ///< column, prior: -log of the prior's mass inside the bounds
};

}  // namespace chaintrue::grid::diagnosis
