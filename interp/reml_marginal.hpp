// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The restricted likelihood of reml.hpp as a function of theta, with two derivatives. Internal to
/// interp; notation as in reml.hpp.

#include <optional>

#include "interp/reml.hpp"
#include "interp/reml_structure.hpp"

namespace chaintrue::interp::reml {

enum class Order { value, hessian };
/// Factorisation of A: whichever is cheaper for many lambda, or dense.
enum class Shape { any, dense };

/// V and its derivatives at one theta. Coefficients are in working coordinates.
struct State {
  double value = 0.0;     ///< V of (3)
  double deviance = 0.0;  ///< |y - X b|^2 / sigma2 + (b - b0)' S (b - b0)
  Eigen::VectorXd coefficients;
  // Filled for Order::hessian only.
  Eigen::VectorXd gradient;
  Eigen::MatrixXd hessian;
};

/// theta = (log lambda_1 .. log lambda_K, then log sigma2 unless it is fixed).
class Marginal {
 public:
  /// `fixed_sigma2` overrides the problem's noise scale.
  Marginal(const PenalisedProblem& problem,
           std::optional<double> fixed_sigma2,
           SmoothingPrior prior = SmoothingPrior::none,
           Shape shape = Shape::any);

  [[nodiscard]] Eigen::Index penalties() const {
    return static_cast<Eigen::Index>(problem_.penalties.size());
  }
  [[nodiscard]] Eigen::Index unknowns() const { return penalties() + (sigma2_free_ ? 1 : 0); }
  [[nodiscard]] double sigma2(const Eigen::VectorXd& theta) const;

  /// Log lambda at which the traces of penalty k and of the data are equal; the search is centred
  /// there.
  [[nodiscard]] double balanced_log_lambda(Eigen::Index k) const;

  /// Derivative of the flat prior's term in V by theta_i.
  [[nodiscard]] double flat_slope(Eigen::Index i) const;
  [[nodiscard]] SmoothingPrior prior() const { return prior_kind_; }
  [[nodiscard]] bool sigma2_free() const { return sigma2_free_; }
  [[nodiscard]] bool noise_from_repeats() const { return extra_degrees_ > 0.0; }
  /// Mean square of the responses, an upper bound of the noise. At least 1e-20: rows are whitened,
  /// and ten digits below the assumed sigma is rounding.
  [[nodiscard]] double response_variance() const;

  /// False if some columns are undetermined for every lambda.
  [[nodiscard]] bool positive() const { return structure_ != nullptr; }
  [[nodiscard]] const Structure& structure() const { return *structure_; }

  /// Empty where A is not positive definite.
  [[nodiscard]] std::optional<State> evaluate(const Eigen::VectorXd& theta, Order order) const;
  /// sum += weight * A^-1 in working coordinates; A must be positive definite at theta. Returns b
  /// there.
  Eigen::VectorXd add_inverse(const Eigen::VectorXd& theta,
                              double weight,
                              WorkingCovariance& sum) const;

 private:
  struct LogDeterminant {
    double value = 0.0;
    Eigen::VectorXd gradient;
    Eigen::MatrixXd hessian;
  };
  [[nodiscard]] BestFit best_fit(const Factor& factor, double s2) const;
  [[nodiscard]] LogDeterminant log_determinant(const Eigen::VectorXd& theta, Order order) const;
  void add_derivatives(State& state, const Factor& factor, const Eigen::VectorXd& theta) const;
  void find_ranks();

  const PenalisedProblem& problem_;
  SmoothingPrior prior_kind_;
  std::unique_ptr<Structure> structure_;
  double prior_square_ = 0.0;  // b0' S0 b0
  bool sigma2_free_ = false;
  double sigma2_fixed_ = 1.0;
  double extra_degrees_ = 0.0;  // d
  std::vector<double> ranks_;   // of the S_k
  // Where the ranges of S0 and the S_k overlap: an orthonormal basis of their joint range.
  bool ranges_overlap_ = false;
  Eigen::MatrixXd range_prior_;                 // U' S0 U
  std::vector<Eigen::MatrixXd> range_penalty_;  // U' S_k U
};

}  // namespace chaintrue::interp::reml
