// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Cholesky>

#include "interp/reml_structure.hpp"

namespace chaintrue::interp::reml {

ScaledCholesky::ScaledCholesky(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& diagonal) {
  const Eigen::VectorXd reference = diagonal.size() > 0 ? diagonal : matrix.diagonal();
  if (!(reference.array() > 0.0).all()) {
    return;
  }
  scale_ = reference.array().rsqrt();
  const Eigen::LLT<Eigen::MatrixXd> factor(scale_.asDiagonal() * matrix * scale_.asDiagonal());
  lower_ = factor.matrixLLT();
  positive_ =
      factor.info() == Eigen::Success && lower_.diagonal().array().square().minCoeff() >
                                             kZeroPivot * static_cast<double>(matrix.rows());
}

double ScaledCholesky::log_determinant() const {
  return 2.0 * (lower_.diagonal().array().log().sum() - scale_.array().log().sum());
}

Eigen::MatrixXd ScaledCholesky::half_solve(const Eigen::MatrixXd& right) const {
  return lower_.triangularView<Eigen::Lower>().solve(scale_.asDiagonal() * right);
}

Eigen::MatrixXd ScaledCholesky::transposed_half_solve(const Eigen::MatrixXd& right) const {
  return scale_.asDiagonal() * lower_.triangularView<Eigen::Lower>().transpose().solve(right);
}

Eigen::MatrixXd ScaledCholesky::solve(const Eigen::MatrixXd& right) const {
  return transposed_half_solve(half_solve(right));
}

Eigen::MatrixXd ScaledCholesky::inverse() const {
  const Eigen::Index n = lower_.rows();
  const Eigen::MatrixXd half = half_solve(Eigen::MatrixXd::Identity(n, n));
  return half.transpose() * half;
}

namespace {

class DenseFactor final : public Factor {
 public:
  DenseFactor(const PenalisedProblem& problem,
              const Eigen::VectorXd& lambda,
              ScaledCholesky cholesky)
      : problem_(problem), lambda_(lambda), cholesky_(std::move(cholesky)) {}

  [[nodiscard]] double log_determinant() const override { return cholesky_.log_determinant(); }
  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const override {
    return cholesky_.solve(right);
  }
  void add_inverse(double weight, WorkingCovariance& sum) const override {
    if (sum.dense.size() == 0) {
      sum.dense = weight * cholesky_.inverse();
    } else {
      sum.dense += weight * cholesky_.inverse();
    }
  }
  [[nodiscard]] Traces traces() const override {
    const Eigen::Index q = problem_.columns();
    const Eigen::MatrixXd c = cholesky_.inverse();
    std::vector<Eigen::MatrixXd> product;  // A^-1 D_i
    for (std::size_t k = 0; k < problem_.penalties.size(); ++k) {
      const Penalty& penalty = problem_.penalties[k];
      const Eigen::Index m = penalty.matrix.rows();
      Eigen::MatrixXd p = Eigen::MatrixXd::Zero(q, q);
      p.middleCols(penalty.first_column, m).noalias() =
          lambda_(static_cast<Eigen::Index>(k)) *
          (c.middleCols(penalty.first_column, m) * penalty.matrix);
      product.push_back(std::move(p));
    }
    product.push_back(problem_.prior_precision.size() > 0
                          ? Eigen::MatrixXd(c * problem_.prior_precision)
                          : Eigen::MatrixXd::Zero(q, q));
    const auto n = static_cast<Eigen::Index>(product.size());
    Traces result{Eigen::VectorXd(n), Eigen::MatrixXd(n, n)};
    for (Eigen::Index i = 0; i < n; ++i) {
      const Eigen::MatrixXd& a = product[static_cast<std::size_t>(i)];
      result.first(i) = a.trace();
      for (Eigen::Index j = 0; j < n; ++j) {
        result.second(i, j) =
            a.cwiseProduct(product[static_cast<std::size_t>(j)].transpose()).sum();
      }
    }
    return result;
  }

 private:
  const PenalisedProblem& problem_;
  Eigen::VectorXd lambda_;
  ScaledCholesky cholesky_;
};

class DenseStructure final : public Structure {
 public:
  explicit DenseStructure(const PenalisedProblem& problem) : problem_(problem) {
    moment_ = problem.moment;
    prior_moment_ = Eigen::VectorXd::Zero(problem.columns());
    if (problem.prior_mean.size() > 0 && problem.prior_precision.size() > 0) {
      prior_moment_ = problem.prior_precision * problem.prior_mean;
    }
  }

  [[nodiscard]] Eigen::VectorXd penalty_times(Eigen::Index k,
                                              const Eigen::VectorXd& b) const override {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(b.size());
    if (k < static_cast<Eigen::Index>(problem_.penalties.size())) {
      const Penalty& penalty = problem_.penalties[static_cast<std::size_t>(k)];
      const Eigen::Index m = penalty.matrix.rows();
      result.segment(penalty.first_column, m) = penalty.matrix * b.segment(penalty.first_column, m);
    } else if (problem_.prior_precision.size() > 0) {
      result = problem_.prior_precision * b;
    }
    return result;
  }

  [[nodiscard]] std::unique_ptr<Factor> factor(const Eigen::VectorXd& lambda,
                                               double sigma2) const override {
    Eigen::MatrixXd a = problem_.gram / sigma2;
    if (problem_.prior_precision.size() > 0) {
      a += problem_.prior_precision;
    }
    for (std::size_t k = 0; k < problem_.penalties.size(); ++k) {
      const Penalty& penalty = problem_.penalties[k];
      const Eigen::Index m = penalty.matrix.rows();
      a.block(penalty.first_column, penalty.first_column, m, m) +=
          lambda(static_cast<Eigen::Index>(k)) * penalty.matrix;
    }
    ScaledCholesky cholesky(a);
    if (!cholesky.positive()) {
      return nullptr;
    }
    return std::make_unique<DenseFactor>(problem_, lambda, std::move(cholesky));
  }

  [[nodiscard]] Eigen::MatrixXd to_columns(const Eigen::MatrixXd& working) const override {
    return working;
  }
  [[nodiscard]] Eigen::MatrixXd covariance_to_columns(
      const WorkingCovariance& covariance, const Eigen::MatrixXd& shifts) const override {
    return covariance.dense + shifts * shifts.transpose();
  }

 private:
  const PenalisedProblem& problem_;
};

}  // namespace

std::unique_ptr<Structure> make_dense(const PenalisedProblem& problem) {
  return std::make_unique<DenseStructure>(problem);
}

}  // namespace chaintrue::interp::reml
