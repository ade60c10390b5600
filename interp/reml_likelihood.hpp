// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The restricted likelihood of reml.hpp as a function of theta = (log lambda, log sigma2), with two
/// derivatives. Internal to interp.
///
/// Notation beyond reml.hpp (F the n x m part of X in the ridge, Z the n x p rest, s and s0 the
/// coefficients and prior means of the rest):
///   R, g     F'F = R diag(g) R'; working coordinates are R' (ridge part of b), then s
///   a        diagonal of A in the ridge: g / sigma2 + lambda
///   C        R' F' Z
///   U        diag(1 / a) C / sigma2
///   H        Schur complement on the rest: Z'Z / sigma2 + S0 - C' U / sigma2
/// A^-1 is diag(1 / a) + U H^-1 U' in the ridge, -U H^-1 beside it, H^-1 in the corner, and
/// log|A| = sum log a + log|H|.                                                               (4)
///
/// With little noise the difference in H cancels. Where the rows are known and n <= m, with
/// F F' = Q diag(g) Q':
///   D        diag(1 / (sigma2 + g / lambda)): Q D Q' is the inverse of sigma2 I + F F' / lambda
///   H        = S0 + Z' Q D Q' Z, all its terms positive                                       (5)
///   s        = H^-1 (S0 s0 + Z' Q D Q' y), and with r = y - Z s the ridge's part of b is
///            F' Q D Q' r / lambda, the deviance r' Q D Q' r + (s - s0)' S0 (s - s0)           (6)

#include <optional>
#include <vector>

#include "interp/linear_algebra.hpp"
#include "interp/reml.hpp"

namespace chaintrue::interp::reml {

using Theta = Eigen::Vector2d;

enum class Order { value, hessian };

/// V and its derivatives at one theta.
struct State {
  double value = 0.0;            ///< V of (3), with the prior's terms
  Eigen::VectorXd coefficients;  ///< in working coordinates
  // Filled for Order::hessian only.
  Theta gradient;
  Eigen::Matrix2d hessian;
};

/// Cholesky factor of a matrix scaled to unit diagonal: the units of a column must not affect its
/// rank.
class ScaledCholesky {
 public:
  /// `diagonal` is what the pivots are compared with.
  ScaledCholesky(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& diagonal);
  [[nodiscard]] bool positive() const { return positive_; }
  [[nodiscard]] double log_determinant() const;
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  /// W with W W' the inverse.
  [[nodiscard]] Eigen::MatrixXd inverse_root() const;

 private:
  Eigen::VectorXd scale_;
  linear::Cholesky factor_;
  bool positive_ = false;
};

class Likelihood {
 public:
  /// Keeps a reference. \throws std::invalid_argument where shapes do not fit or a number is not
  /// finite.
  Likelihood(const PenalisedProblem& problem, SmoothingPrior prior);
  /// For one theta: the ridge is treated as a prior, so no eigendecomposition is needed.
  Likelihood(const PenalisedProblem& problem, const Theta& fixed);

  [[nodiscard]] bool has_ridge() const { return eigenvalues_.size() > 0; }
  [[nodiscard]] bool finds_sigma2() const { return finds_sigma2_; }
  [[nodiscard]] bool noise_from_repeats() const { return extra_degrees_ > 0.0; }
  /// The lambda at which the ridge weighs as much as the data; 0 if the data do not determine it.
  [[nodiscard]] double balance() const;
  /// Mean square of the responses, an upper bound of the noise. At least 1e-20: rows are whitened,
  /// so ten digits below the assumed sigma is rounding.
  [[nodiscard]] double response_variance() const;
  /// Derivatives of the flat prior's terms in V, whether or not V includes them.
  [[nodiscard]] Theta flat_slope() const;
  [[nodiscard]] SmoothingPrior prior() const { return prior_kind_; }

  /// Empty where A is not positive definite to rounding.
  [[nodiscard]] std::optional<State> evaluate(const Theta& theta, Order order) const;

  /// A point of a distribution of theta.
  struct Node {
    Theta theta;
    double weight;
  };
  /// Sum of weight (A^-1 + (b - b_c)(b - b_c)') over the nodes, in the problem's columns, with b_c
  /// the coefficients of `centre`. A must be positive definite at every node.
  [[nodiscard]] Eigen::MatrixXd covariance(const std::vector<Node>& nodes,
                                           const State& centre) const;
  /// From working coordinates to the problem's columns.
  [[nodiscard]] Eigen::MatrixXd to_columns(const Eigen::MatrixXd& working) const;

 private:
  /// A at one theta.
  struct Factor {
    double lambda;
    double sigma2;
    Eigen::VectorXd inverse;  // 1 / a
    Eigen::MatrixXd u;        // U
    Eigen::VectorXd of_rows;  // D, where the rows are turned
    ScaledCholesky corner;    // of H
    double log_determinant;
  };
  /// The minimiser of |y - X b|^2 / sigma2 + (b - b0)' S (b - b0), and that minimum.
  struct BestFit {
    Eigen::VectorXd coefficients;
    double deviance;
  };
  void gather(const Ridge& ridge);
  void diagonalise();
  [[nodiscard]] std::optional<Factor> factor(const Theta& theta) const;
  [[nodiscard]] BestFit solve(const Factor& factor) const;
  void add_derivatives(State& state, const Factor& factor, double deviance) const;

  const PenalisedProblem& problem_;
  SmoothingPrior prior_kind_;
  bool finds_sigma2_ = false;
  double extra_degrees_ = 0.0;        // d
  Eigen::Index first_ = 0;            // of the ridge's columns
  std::vector<Eigen::Index> shared_;  // the columns outside the ridge
  Eigen::MatrixXd shared_gram_;       // Z'Z
  Eigen::MatrixXd shared_prior_;      // S0
  Eigen::VectorXd shared_mean_;       // s0
  Eigen::MatrixXd basis_;             // R
  Eigen::VectorXd eigenvalues_;       // g, m numbers
  Eigen::MatrixXd coupling_;          // C
  Eigen::VectorXd moment_;            // R'F'y, then Z'y
  /// The rows turned by Q, for (5) and (6).
  struct TurnedRows {
    Eigen::VectorXd eigenvalues;
    Eigen::MatrixXd shared;    // Q'Z
    Eigen::VectorXd response;  // Q'y
    Eigen::MatrixXd to_ridge;  // R'F'Q
  };
  std::optional<TurnedRows> rows_;
};

}  // namespace chaintrue::interp::reml
