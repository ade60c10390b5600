// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// The restricted likelihood of reml.hpp as a function of theta = (log lambda, log sigma2), with two
/// derivatives. Internal to interp.
///
/// Notation beyond reml.hpp (F the part of X in the ridge, Z the rest with p columns, s and s0 the
/// coefficients and prior means of the rest). An orthogonal transformation of the rows changes
/// nothing, so they are first reduced to q + 1 where there are more (the triangle of [F Z y]), k being
/// their number then, and turned by Q:
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

#include <optional>
#include <vector>

#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"
#include "interp/reml.hpp"

namespace chaintrue::interp::reml {

using Theta = Vector2d;

/// The fit at one theta.
struct State {
  Theta theta = Theta::Zero();
  double value = 0.0;  ///< V of (4), with the prior's terms
  VectorXd weights;    ///< D
  VectorXd shared;     ///< s
  VectorXd residual;   ///< r
  MatrixXd root;       ///< W with W W' = H^-1
  double lambda() const;
  double sigma2() const;
};

/// The derivatives of V at a state.
struct Derivatives {
  Theta gradient;
  Matrix2d hessian;
};

class Likelihood {
 public:
  /// Keeps a reference. \throws std::invalid_argument where shapes do not fit or a number is not
  /// finite.
  Likelihood(const PenalisedProblem& problem, SmoothingPrior prior);

  bool has_ridge() const { return problem_.ridge.count > 0; }
  NoiseKnowledge noise() const { return problem_.noise.knowledge; }
  /// The lambda at which the ridge weighs as much as the data; 0 if the data do not determine it.
  double balance() const;
  /// Mean square of the responses, an upper bound of the noise. At least 1e-20: rows are whitened,
  /// so ten digits below the assumed sigma is rounding.
  double response_variance() const;
  /// Derivatives of the prior's terms that V lacks.
  Theta left_out_slope() const { return flat_slope() - prior_slope_; }

  /// Empty where A is not positive definite to rounding.
  std::optional<State> at(const Theta& theta) const;
  Derivatives derivatives(const State& state) const;
  /// b, in the problem's columns.
  VectorXd coefficients(const State& state) const;
  /// Trace of the hat matrix.
  double edf(const State& state) const;

  /// A point of a distribution of theta.
  struct Node {
    Theta theta;
    double weight;
  };
  /// Sum of weight (A^-1 + (b - b_c)(b - b_c)') over the nodes, in the problem's columns, with b_c
  /// the coefficients of `centre`. A must be positive definite at every node.
  MatrixXd covariance(const std::vector<Node>& nodes, const State& centre) const;

 private:
  void turn_rows();
  /// Derivatives of the flat prior's terms.
  Theta flat_slope() const;

  const PenalisedProblem& problem_;
  double degrees_ = 0.0;  // d
  Theta prior_slope_ = Theta::Zero();
  std::vector<Index> shared_;  // the columns outside the ridge
  MatrixXd shared_prior_;      // S0
  VectorXd shared_mean_;       // s0
  VectorXd eigenvalues_;       // g
  MatrixXd rows_;              // Z
  VectorXd response_;          // y
  MatrixXd basis_;             // R
  MatrixXd to_ridge_;          // F'Q
};

}  // namespace chaintrue::interp::reml
