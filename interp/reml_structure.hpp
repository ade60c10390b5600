// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Two factorisations of A = X'X / sigma2 + S0 + sum lambda_k S_k at many lambda (internal to
/// interp; notation as in reml.hpp). Both answer in working coordinates, b = T (working b).
///
///   dense     any penalties; each lambda costs O(q^3). T is the identity.
///   bordered  each penalty has columns of its own, coupled to the others only through the p
///             columns that no penalty touches: A is bordered block-diagonal. T diagonalises the
///             penalty and X'X of each block together, and each lambda costs O(q p^2).

#include <memory>
#include <optional>
#include <vector>

#include "interp/reml.hpp"

namespace chaintrue::interp::reml {

/// \throws std::invalid_argument where shapes do not fit or a number is not finite.
void check(const PenalisedProblem& problem);

/// Traces of A^-1 D_i and of A^-1 D_i A^-1 D_j, where D_i = lambda_i S_i and the last is D = S0.
struct Traces {
  Eigen::VectorXd first;
  Eigen::MatrixXd second;
};

/// A covariance in working coordinates: diag(diagonal) + dense + sum of weight W W' over the roots
/// W. An empty part is zero; the dense form fills `dense` alone, the bordered one the others.
struct WorkingCovariance {
  struct Root {
    double weight;
    Eigen::MatrixXd columns;
  };
  Eigen::VectorXd diagonal;
  Eigen::MatrixXd dense;
  std::vector<Root> roots;
};

/// The coefficients that minimise |y - X b|^2 / sigma2 + (b - b0)' S (b - b0), and that minimum.
struct BestFit {
  Eigen::VectorXd coefficients;
  double deviance = 0.0;
};

/// A at one lambda and sigma2.
class Factor {
 public:
  virtual ~Factor() = default;
  /// Where it is more accurate than solve(X'y / sigma2 + S0 b0).
  [[nodiscard]] virtual std::optional<BestFit> best() const { return std::nullopt; }
  [[nodiscard]] virtual double log_determinant() const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const = 0;
  [[nodiscard]] virtual Traces traces() const = 0;
  /// sum += weight * A^-1.
  virtual void add_inverse(double weight, WorkingCovariance& sum) const = 0;
};

class Structure {
 public:
  virtual ~Structure() = default;
  [[nodiscard]] const Eigen::VectorXd& moment() const { return moment_; }
  [[nodiscard]] const Eigen::VectorXd& prior_moment() const { return prior_moment_; }
  /// S_k b; k one past the last penalty stands for S0.
  [[nodiscard]] virtual Eigen::VectorXd penalty_times(Eigen::Index k,
                                                      const Eigen::VectorXd& b) const = 0;
  /// Null where A is not positive definite to rounding.
  [[nodiscard]] virtual std::unique_ptr<Factor> factor(const Eigen::VectorXd& lambda,
                                                       double sigma2) const = 0;
  [[nodiscard]] virtual Eigen::MatrixXd to_columns(const Eigen::MatrixXd& working) const = 0;
  /// T (covariance + shifts shifts') T'; `shifts` may have no columns.
  [[nodiscard]] virtual Eigen::MatrixXd covariance_to_columns(
      const WorkingCovariance& covariance, const Eigen::MatrixXd& shifts) const = 0;

 protected:
  Eigen::VectorXd moment_;        // T' X'y
  Eigen::VectorXd prior_moment_;  // T' S0 b0
};

/// Null where a block's own data and penalty leave some of its columns free.
[[nodiscard]] std::unique_ptr<Structure> make_bordered(const PenalisedProblem& problem);
[[nodiscard]] std::unique_ptr<Structure> make_dense(const PenalisedProblem& problem);
/// Whether the problem has the structure that make_bordered needs.
[[nodiscard]] bool is_bordered(const PenalisedProblem& problem);

/// A pivot of the unit-diagonal A below this share of q means that a combination of columns is
/// free.
inline constexpr double kZeroPivot = 1e-12;

/// Cholesky factor of a matrix scaled to unit diagonal: the units of a column must not affect its
/// rank.
class ScaledCholesky {
 public:
  /// `diagonal` is what the pivots are compared with; empty: the matrix's own diagonal.
  explicit ScaledCholesky(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& diagonal = {});
  [[nodiscard]] bool positive() const { return positive_; }
  [[nodiscard]] double log_determinant() const;
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const;
  [[nodiscard]] Eigen::MatrixXd inverse() const;
  /// L^-1 right and L^-T right with L L' = matrix.
  [[nodiscard]] Eigen::MatrixXd half_solve(const Eigen::MatrixXd& right) const;
  [[nodiscard]] Eigen::MatrixXd transposed_half_solve(const Eigen::MatrixXd& right) const;

 private:
  Eigen::VectorXd scale_;
  Eigen::MatrixXd lower_;
  bool positive_ = false;
};

}  // namespace chaintrue::interp::reml
