// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Penalised least squares with the smoothing chosen by restricted maximum likelihood (REML).
///
/// Notation (rows are whitened: unit weight, noise variance sigma2):
///
///     y = X b + e,   e ~ N(0, sigma2 I)                                                        (1)
///     b ~ N(b0, (S0 + sum_k lambda_k S_k)^-)                                                   (2)
///
///   y        n responses
///   X        n x q design
///   b        q coefficients
///   b0       prior mean (enters through S0 only)
///   S0       fixed prior precision, singular where nothing is known beforehand
///   S_k      penalty k, positive semidefinite
///   lambda_k its unknown precision, >= 0
///   A        X'X / sigma2 + S0 + sum lambda_k S_k, the posterior precision of b
///   V        minus twice the restricted log likelihood, up to a constant:
///
///     V = n log sigma2 + |y - X b|^2 / sigma2 + (b - b0)' S (b - b0) + log|A| - log|S|_+    (3)
///
/// with b = A^-1 (X'y / sigma2 + S0 b0) and |S|_+ the product of the non-zero eigenvalues. A noise
/// scale known from d degrees of freedom adds d log sigma2 + d / sigma2. With few points V is often
/// flat towards lambda -> infinity, and plain REML then estimates a field of zero. A prior flat in
/// the standard deviations lambda^(-1/2) and (where it is unknown) sigma keeps the fit away from
/// that boundary: it adds sum log lambda_k - log sigma2 to V, one unit of log lambda against dozens
/// from the data, and at 28 points lowers the error by 2 % (noise stated) to 11 % (unknown). The
/// corrected covariance averages b over lambda and sigma2 under that prior. Sources: S. Wood, Fast
/// stable restricted maximum likelihood ..., J. R. Statist. Soc. B 73 (2011) 3-36, equations (4)
/// and (5), for V; Y. Chung, S. Rabe-Hesketh, V. Dorie, A. Gelman, J. Liu, A nondegenerate
/// penalized likelihood estimator for variance parameters ..., Psychometrika 78 (2013) 685-709, for
/// the prior.
///
/// lambda multiplies an absolute precision, so that priors in S0 keep their stated sigmas whatever
/// sigma2 turns out to be. The usual smoothing parameter relative to the noise is sigma2 * lambda.

#include <string>
#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

namespace chaintrue::interp {

/// A quadratic penalty on the columns first_column .. first_column + matrix.rows() - 1.
struct Penalty {
  Eigen::Index first_column = 0;
  Eigen::MatrixXd matrix;
  Eigen::Index rank = -1;  ///< of `matrix`; negative: found from its eigenvalues
  /// The lambda that the search for it is centred on; 0: where the traces of the penalty and of X'X
  /// are equal.
  double balance = 0.0;
};

/// Prior knowledge of the noise scale sigma2.
enum class NoiseKnowledge {
  exact,         ///< sigma2 = 1: the whitening is right
  from_repeats,  ///< sigma2 about 1, known from `degrees_of_freedom` (scaled inverse chi-square)
  unknown,       ///< sigma2 free
};

struct NoiseScale {
  NoiseKnowledge knowledge = NoiseKnowledge::exact;
  double degrees_of_freedom = 0.0;  ///< for `from_repeats`
};

/// The data of a fit, reduced to what the fit needs: n, X'X, X'y, y'y.
///
///     PenalisedProblem problem(q);
///     problem.add_rows(design, response);          // whitened
///     problem.penalties = {{0, basis.thin_plate_penalty(), basis.thin_plate_rank()}};
///     auto fit = fit_penalised(problem);
struct PenalisedProblem {
  explicit PenalisedProblem(Eigen::Index columns);

  void add_rows(const Eigen::Ref<const Eigen::MatrixXd>& design,
                const Eigen::Ref<const Eigen::VectorXd>& response);
  /// One row whose only non-zero entries are `values` at `columns`.
  void add_sparse_row(const std::vector<Eigen::Index>& columns,
                      const std::vector<double>& values,
                      double response);

  [[nodiscard]] Eigen::Index columns() const { return gram.cols(); }

  Eigen::Index rows = 0;
  Eigen::MatrixXd gram;             ///< X'X
  Eigen::VectorXd moment;           ///< X'y
  double response_square = 0.0;     ///< y'y
  Eigen::MatrixXd prior_precision;  ///< S0, q x q; empty: none
  Eigen::Index prior_rank = -1;     ///< of S0; negative: found from its eigenvalues
  Eigen::VectorXd prior_mean;       ///< b0; empty: zero
  std::vector<Penalty> penalties;
  NoiseScale noise;
  /// Set before the first row: add_rows then keeps X and y as well. Where one penalty is the
  /// identity, no prior touches its columns and there are no more rows than such columns, a fit
  /// keeps full precision however small the noise is; X'X alone loses it by squaring.
  bool keeps_rows = false;
  Eigen::MatrixXd design;
  Eigen::VectorXd response;
};

/// Where the search for one lambda ended.
enum class SmoothingEnd {
  inside,       ///< at a minimum of V
  stiff,        ///< lambda at its upper limit: only the penalty's null space is left
  interpolate,  ///< lambda at its lower limit: the penalty does nothing
};

/// Why a fit has no result.
enum class FitReason {
  rank_deficient,  ///< data, priors and penalties together leave a combination of columns free
  not_converged,   ///< the search for the smoothing did not converge
};
/// Has the shape of model's Failure, which interp does not know.
struct FitFailure {
  using Reason = FitReason;
  FitReason reason;
  std::string text;
  [[nodiscard]] const std::string& sentence() const { return text; }
};

/// Residuals of a group of rows left out of the fit, smoothing held fixed.
struct HeldOut {
  Eigen::VectorXd residual;    ///< y_g - X_g b(without g) = (I - H_gg)^-1 (y_g - X_g b)
  Eigen::MatrixXd covariance;  ///< of that residual: sigma2 (I - H_gg)^-1
};

/// The fitted model. Covariances are of the Bayesian posterior (2).
struct PenalisedFit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd covariance;            ///< A^-1, smoothing and sigma2 taken as known
  Eigen::MatrixXd corrected_covariance;  ///< smoothing and sigma2 averaged over
  Eigen::VectorXd lambda;
  Eigen::VectorXd inverse_lambda;    ///< averaged as corrected_covariance is: the prior variance
  Eigen::VectorXd log_lambda_sigma;  ///< standard error of log lambda; infinite at a limit
  std::vector<SmoothingEnd> ends;
  double sigma2 = 1.0;
  double residual_square = 0.0;     ///< |y - X b|^2
  double edf = 0.0;                 ///< trace of the hat matrix
  Eigen::VectorXd column_edf;       ///< its share of each column: diagonal of A^-1 X'X / sigma2
  double minus_two_log_reml = 0.0;  ///< V of (3), plus the prior's terms where there is one
  int iterations = 0;

  /// Closed-form residuals and their covariance with the rows of `design` left out. An error when
  /// the remaining data do not determine the fit (I - H_gg not positive definite).
  [[nodiscard]] tl::expected<HeldOut, FitFailure> held_out(
      const Eigen::Ref<const Eigen::MatrixXd>& design,
      const Eigen::Ref<const Eigen::VectorXd>& response) const;
};

/// The residual alone, from the group's m residuals y_g - X_g b and X_g A^-1 X_g' (m x m). To leave
/// out many groups, these matrices can be computed in one product.
[[nodiscard]] tl::expected<Eigen::VectorXd, FitFailure> held_out_residual(
    const Eigen::Ref<const Eigen::VectorXd>& residual,
    const Eigen::Ref<const Eigen::MatrixXd>& spread,
    double sigma2);

/// The same for a group of many rows, with W W' = X_g A^-1 X_g' (W is m x q): costs m q^2 + q^3,
/// not m^3.
[[nodiscard]] tl::expected<Eigen::VectorXd, FitFailure> held_out_residual_by_root(
    const Eigen::Ref<const Eigen::VectorXd>& residual,
    const Eigen::Ref<const Eigen::MatrixXd>& root,
    double sigma2);

/// Prior on lambda and, where it is unknown, on sigma2.
enum class SmoothingPrior {
  none,             ///< plain REML
  avoids_boundary,  ///< flat in the standard deviations lambda^(-1/2) and sigma; see above
};

struct FitOptions {
  SmoothingPrior prior = SmoothingPrior::avoids_boundary;
  bool correct_covariance = true;  ///< fill corrected_covariance
  int maximum_iterations = 100;
};

/// Chooses lambda and sigma2 and fits. Deterministic: same input, same bytes. Throws
/// std::invalid_argument when shapes do not fit or a number is not finite.
/// Cost: O(q^3) once, and O(q p^2) for each of some 60 evaluations of V while each penalty has
/// columns of its own that the data couple to the others only through p unpenalised columns; O(q^3)
/// for each evaluation otherwise.
[[nodiscard]] tl::expected<PenalisedFit, FitFailure> fit_penalised(const PenalisedProblem& problem,
                                                                   const FitOptions& options = {});

/// The same with lambda and sigma2 given; log_lambda_sigma is zero. Cost: O(q^3).
[[nodiscard]] tl::expected<PenalisedFit, FitFailure> fit_with_smoothing(
    const PenalisedProblem& problem,
    const Eigen::Ref<const Eigen::VectorXd>& lambda,
    double sigma2);

/// V of (3) at given lambda and sigma2, from scratch; for tests and plots.
[[nodiscard]] tl::expected<double, FitFailure> minus_two_log_reml(
    const PenalisedProblem& problem,
    const Eigen::Ref<const Eigen::VectorXd>& lambda,
    double sigma2);

}  // namespace chaintrue::interp
