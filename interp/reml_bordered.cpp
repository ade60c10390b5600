// SPDX-License-Identifier: GPL-3.0-or-later
// Notation and equations as in the header.
#include "interp/reml_bordered.hpp"

#include <algorithm>

#include "interp/symmetric_eigen.hpp"

namespace chaintrue::interp::reml {
namespace {

class BorderedStructure final : public Structure {
 public:
  explicit BorderedStructure(const PenalisedProblem& problem) : columns_(problem.columns()) {
    gather_shared(problem);
    Eigen::Index working = 0;
    for (const Penalty& penalty : problem.penalties) {
      if (!add_block(problem, penalty, working)) {
        return;
      }
      working += penalty.matrix.rows();
    }
    positive_ = true;
    if (has_rows_for_a_ridge(problem)) {
      turn_rows(problem);
    }
    moment_ = to_working(problem.moment);
    Eigen::VectorXd prior_moment = Eigen::VectorXd::Zero(columns_);
    if (problem.prior_mean.size() > 0 && problem.prior_precision.size() > 0) {
      prior_moment = problem.prior_precision * problem.prior_mean;
    }
    prior_moment_ = to_working(prior_moment);
  }

  [[nodiscard]] bool positive() const { return positive_; }

  [[nodiscard]] Eigen::VectorXd penalty_times(Eigen::Index k,
                                              const Eigen::VectorXd& b) const override {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(columns_);
    if (k < static_cast<Eigen::Index>(blocks_.size())) {
      const Block& block = blocks_[static_cast<std::size_t>(k)];
      const Eigen::Index m = block.weight.size();
      result.segment(block.first_working, m) =
          block.weight.cwiseProduct(b.segment(block.first_working, m)) / block.balance;
    } else {
      const Eigen::Index p = shared_.gram.rows();
      result.tail(p) = shared_.prior * b.tail(p);
    }
    return result;
  }

  [[nodiscard]] std::unique_ptr<Factor> factor(const Eigen::VectorXd& lambda,
                                               double sigma2) const override {
    return make_bordered_factor(blocks_, shared_, rows_, lambda, sigma2);
  }

  [[nodiscard]] Eigen::MatrixXd to_columns(const Eigen::MatrixXd& working) const override {
    Eigen::MatrixXd result(columns_, working.cols());
    for (const Block& block : blocks_) {
      const Eigen::Index m = block.weight.size();
      result.middleRows(block.first_column, m).noalias() =
          block.basis * working.middleRows(block.first_working, m);
    }
    const Eigen::Index p = shared_.gram.rows();
    for (Eigen::Index i = 0; i < p; ++i) {
      result.row(shared_.columns[static_cast<std::size_t>(i)]) =
          working.row(working.rows() - p + i);
    }
    return result;
  }

  [[nodiscard]] Eigen::MatrixXd covariance_to_columns(
      const WorkingCovariance& covariance, const Eigen::MatrixXd& shifts) const override {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(columns_, columns_);
    for (const Block& block : blocks_) {
      const Eigen::Index m = block.weight.size();
      const Eigen::MatrixXd half =
          block.basis *
          covariance.diagonal.segment(block.first_working, m).cwiseSqrt().asDiagonal();
      result.block(block.first_column, block.first_column, m, m)
          .selfadjointView<Eigen::Lower>()
          .rankUpdate(half);
    }
    if (shifts.cols() > 0) {
      result.selfadjointView<Eigen::Lower>().rankUpdate(to_columns(shifts));
    }
    if (!covariance.roots.empty()) {
      // One product for each sign: one wide product is faster than many narrow ones.
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(columns_, columns_);
      for (const double sign : {1.0, -1.0}) {
        const Eigen::MatrixXd wide = side_by_side(covariance.roots, sign);
        if (wide.cols() > 0) dense.selfadjointView<Eigen::Lower>().rankUpdate(wide, sign);
      }
      dense.triangularView<Eigen::StrictlyUpper>() = dense.transpose();
      const Eigen::MatrixXd half = to_columns(dense).transpose();
      result.triangularView<Eigen::Lower>() += to_columns(half);
    }
    result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
    return result;
  }

 private:
  /// The roots whose weights have that sign, each times the square root of its weight's absolute
  /// value, as columns.
  [[nodiscard]] Eigen::MatrixXd side_by_side(const std::vector<WorkingCovariance::Root>& roots,
                                             double sign) const {
    Eigen::Index width = 0;
    for (const auto& root : roots) {
      width += root.weight * sign > 0.0 ? root.columns.cols() : 0;
    }
    Eigen::MatrixXd all(columns_, width);
    Eigen::Index at = 0;
    for (const auto& root : roots) {
      if (root.weight * sign > 0.0) {
        all.middleCols(at, root.columns.cols()) = std::sqrt(std::abs(root.weight)) * root.columns;
        at += root.columns.cols();
      }
    }
    return all;
  }

  void gather_shared(const PenalisedProblem& problem) {
    std::vector<bool> penalised(static_cast<std::size_t>(columns_), false);
    for (const Penalty& penalty : problem.penalties) {
      std::fill_n(penalised.begin() + penalty.first_column, penalty.matrix.rows(), true);
    }
    for (Eigen::Index i = 0; i < columns_; ++i) {
      if (!penalised[static_cast<std::size_t>(i)]) {
        shared_.columns.push_back(i);
      }
    }
    shared_.gram = problem.gram(shared_.columns, shared_.columns);
    shared_.prior = Eigen::MatrixXd::Zero(shared_.gram.rows(), shared_.gram.rows());
    if (problem.prior_precision.size() > 0) {
      shared_.prior = problem.prior_precision(shared_.columns, shared_.columns);
    }
    shared_.mean = Eigen::VectorXd::Zero(shared_.gram.rows());
    if (problem.prior_mean.size() > 0) {
      shared_.mean = problem.prior_mean(shared_.columns);
    }
  }

  static bool has_rows_for_a_ridge(const PenalisedProblem& problem) {
    return problem.keeps_rows && problem.penalties.size() == 1 &&
           problem.rows <= problem.penalties[0].matrix.rows() &&
           problem.penalties[0].matrix.isIdentity(0.0);
  }

  void turn_rows(const PenalisedProblem& problem) {
    const Block& block = blocks_.front();
    const Eigen::MatrixXd penalised =
        problem.design.middleCols(block.first_column, block.weight.size());
    const SymmetricEigen solver(penalised * penalised.transpose());
    const Eigen::MatrixXd& q = solver.eigenvectors();
    // T = R diag((d + c)^-1/2) with R orthonormal, hence T^-1 = diag(d + c) T'; w = c / (d + c).
    rows_ = TurnedRows{solver.eigenvalues().cwiseMax(0.0),
                       q.transpose() * problem.design(Eigen::all, shared_.columns),
                       q.transpose() * problem.response,
                       (block.balance * block.weight.cwiseInverse()).asDiagonal() *
                           (block.basis.transpose() * (penalised.transpose() * q))};
  }

  bool add_block(const PenalisedProblem& problem, const Penalty& penalty, Eigen::Index working) {
    const Eigen::Index m = penalty.matrix.rows();
    const auto gram = problem.gram.block(penalty.first_column, penalty.first_column, m, m);
    const double trace = penalty.matrix.trace();
    Block block{penalty.first_column, working, {}, {}, gram.trace() / trace, 0.0, {}};
    if (!(trace > 0.0) || !(block.balance > 0.0)) {
      return false;
    }
    const bool diagonalised = penalty.matrix.isIdentity(0.0) ? diagonalise_ridge(gram, block)
                                                             : diagonalise(gram, penalty, block);
    if (!diagonalised) {
      return false;
    }
    Eigen::MatrixXd shared_columns(m, static_cast<Eigen::Index>(shared_.columns.size()));
    for (std::size_t i = 0; i < shared_.columns.size(); ++i) {
      shared_columns.col(static_cast<Eigen::Index>(i)) =
          problem.gram.col(shared_.columns[i]).segment(penalty.first_column, m);
    }
    block.coupling = block.basis.transpose() * shared_columns;
    blocks_.push_back(std::move(block));
    return true;
  }

  /// (1) for any penalty.
  static bool diagonalise(const Eigen::MatrixXd& gram, const Penalty& penalty, Block& block) {
    const ScaledCholesky cholesky(gram + block.balance * penalty.matrix);
    if (!cholesky.positive()) {
      return false;
    }
    const Eigen::MatrixXd half = cholesky.half_solve(penalty.matrix);
    const Eigen::MatrixXd scaled = block.balance * cholesky.half_solve(half.transpose());
    const SymmetricEigen solver(scaled);
    block.weight = solver.eigenvalues().cwiseMax(0.0).cwiseMin(1.0);
    // Eigenvalues come in rising order: the first are the penalty's null space.
    const Eigen::Index nullity = penalty.rank >= 0 ? gram.rows() - penalty.rank : 0;
    block.weight.head(nullity).setZero();
    block.basis = cholesky.transposed_half_solve(solver.eigenvectors());
    block.log_basis = -0.5 * cholesky.log_determinant();
    return true;
  }

  /// (1) where the penalty is the identity: the eigenvectors of G suffice.
  static bool diagonalise_ridge(const Eigen::MatrixXd& gram, Block& block) {
    const SymmetricEigen solver(gram);
    const Eigen::VectorXd sum = solver.eigenvalues().cwiseMax(0.0).array() + block.balance;
    block.weight = block.balance * sum.cwiseInverse();
    block.basis = solver.eigenvectors() * sum.cwiseSqrt().cwiseInverse().asDiagonal();
    block.log_basis = -0.5 * sum.array().log().sum();
    return true;
  }

  [[nodiscard]] Eigen::VectorXd to_working(const Eigen::VectorXd& columns) const {
    Eigen::VectorXd result(columns_);
    for (const Block& block : blocks_) {
      const Eigen::Index m = block.weight.size();
      result.segment(block.first_working, m) =
          block.basis.transpose() * columns.segment(block.first_column, m);
    }
    const Eigen::Index p = shared_.gram.rows();
    for (Eigen::Index i = 0; i < p; ++i) {
      result(columns_ - p + i) = columns(shared_.columns[static_cast<std::size_t>(i)]);
    }
    return result;
  }

  Eigen::Index columns_;
  std::vector<Block> blocks_;
  Shared shared_;
  std::optional<TurnedRows> rows_;
  bool positive_ = false;
};

}  // namespace

bool is_bordered(const PenalisedProblem& problem) {
  std::vector<int> owner(static_cast<std::size_t>(problem.columns()), -1);
  for (std::size_t k = 0; k < problem.penalties.size(); ++k) {
    const Penalty& penalty = problem.penalties[k];
    for (Eigen::Index i = 0; i < penalty.matrix.rows(); ++i) {
      int& mine = owner[static_cast<std::size_t>(penalty.first_column + i)];
      if (mine >= 0) {
        return false;
      }
      mine = static_cast<int>(k);
    }
    const bool prior_here =
        problem.prior_precision.size() > 0 &&
        !problem.prior_precision.middleCols(penalty.first_column, penalty.matrix.rows())
             .isZero(0.0);
    if (prior_here) {
      return false;
    }
  }
  for (Eigen::Index j = 0; j < problem.columns(); ++j) {
    for (Eigen::Index i = 0; i < problem.columns(); ++i) {
      const int a = owner[static_cast<std::size_t>(i)];
      const int b = owner[static_cast<std::size_t>(j)];
      if (a != b && a >= 0 && b >= 0 && problem.gram(i, j) != 0.0) {
        return false;
      }
    }
  }
  return true;
}

std::unique_ptr<Structure> make_bordered(const PenalisedProblem& problem) {
  auto result = std::make_unique<BorderedStructure>(problem);
  if (!result->positive()) {
    return nullptr;
  }
  return result;
}

}  // namespace chaintrue::interp::reml
