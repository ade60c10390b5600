// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The restricted likelihood of reml.hpp as a function of theta = (log lambda, log sigma2), with two
/// derivatives. Internal to interp.
///
/// Notation beyond reml.hpp, with X = [Z F], F in the ridge; s and s0 the coefficients and prior means
/// of the other p columns. An orthogonal transformation of the rows changes nothing, so they are first
/// reduced to q + 1 where there are more (the triangle of [Z F y]), k being their number then, and
/// turned by Q:
///   Q, g     F F' = Q diag(g) Q'; from here on Z and y stand for Q'Z and Q'y
///   R        orthonormal, its first columns along those of F'Q; beyond them g = 0
///   D        diag(1 / w), w = sigma2 + g / lambda: the rows are independent with variances w
///   H        S0 + Z' D Z, all its terms positive
///   s        H^-1 (S0 s0 + Z' D y), and r = y - Z s
///   a        g / sigma2 + lambda
///   U        F' Q D Z / lambda
///
///     V      = (n - k) log sigma2 + sum log w + log|H| + r' D r + (s - s0)' S0 (s - s0)      (4)
///     b      = F' Q D r / lambda in the ridge                                                 (5)
///     A^-1   = R diag(1 / a) R' + U H^-1 U' in the ridge, -U H^-1 beside it, H^-1 elsewhere   (6)
///
/// With K = Z H^-1 Z' and e_i = D dw / dtheta_i (elementwise, dw / d log lambda = -g / lambda)
///
///     dV     = sum e_i (1 - D (r^2 + K_jj))                                                   (7)
///     d2V    = sum e_i e_j (2 D (r^2 + K_jj) - 1) + sum D (1 - D (r^2 + K_jj)) d2w
///              - 2 (D e_i r)' K (D e_j r) - (D e_i)' (K o K) (D e_j)                          (8)

#include <cmath>
#include <optional>
#include <vector>

#include "interp/eigen.hpp"
#include "interp/reml.hpp"

namespace chaintrue::interp::reml {

using Theta = Vector2d;

/// The fit at one theta.
struct State {
  Theta theta;
  double value = 0.0;  ///< V of (4), with the prior's terms
  VectorXd weights;    ///< D
  VectorXd shared;     ///< s
  VectorXd residual;   ///< r
  MatrixXd root;       ///< W with W W' = H^-1, upper triangular
  double lambda() const { return std::exp(theta[0]); }
  double sigma2() const { return std::exp(theta[1]); }
};

/// The derivatives of V at a state.
struct Derivatives {
  Theta gradient;
  Matrix2d hessian;
};

/// A point of a distribution of theta.
struct Node {
  State state;
  double weight;
};

class Likelihood {
 public:
  /// Keeps a reference. \throws std::invalid_argument where shapes do not fit or a number is not
  /// finite.
  Likelihood(const PenalisedProblem& problem, SmoothingPrior prior);

  const PenalisedProblem& problem() const { return problem_; }
  bool has_ridge() const { return problem_.ridge.count > 0; }
  /// Derivatives of the flat prior's terms where V lacks them.
  const Theta& left_out_slope() const { return left_out_slope_; }

  /// Empty where A is not positive definite to rounding.
  std::optional<State> at(const Theta& theta) const;
  Derivatives derivatives(const State& state) const;
  /// b
  VectorXd coefficients(const State& state) const;
  /// Trace of the hat matrix.
  double edf(const State& state) const;
  /// Sum of weight (A^-1 + (b - b_c)(b - b_c)') over the nodes, with b_c the coefficients of `centre`.
  MatrixXd covariance(const std::vector<Node>& nodes, const State& centre) const;

 private:
  void turn_rows();

  const PenalisedProblem& problem_;
  double degrees_ = 0.0;         // d
  Theta slope_ = Theta::Zero();  // of the terms of V that are linear in theta
  Theta left_out_slope_ = Theta::Zero();
  VectorXd eigenvalues_;  // g
  MatrixXd rows_;         // Z
  VectorXd response_;     // y
  MatrixXd basis_;        // R
  MatrixXd to_ridge_;     // F'Q
};

}  // namespace chaintrue::interp::reml
