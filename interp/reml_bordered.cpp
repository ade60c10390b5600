// SPDX-License-Identifier: GPL-3.0-or-later
// A is bordered block-diagonal: a block for each penalty, and a border of the shared columns.
//
// Notation beyond reml.hpp, for one block with Gram matrix G and penalty S:
//   c        balances the traces of G and S
//   T        T' (G + c S) T = I and T' c S T = diag(w), hence T' G T = diag(1 - w)            (1)
//   a        diagonal of A in the block: (1 - w) / sigma2 + (lambda / c) w
//   C        T' times the Gram matrix of the block with the p shared columns
//   U        diag(1 / a) C / sigma2
//   H        Schur complement on the shared columns:
//            G_pp / sigma2 + S0 - sum C' diag(1 / a) C / sigma2^2
// A^-1 is diag(1 / a) + U H^-1 U' within the blocks, -U H^-1 beside them, H^-1 in the corner. (2)
//
// With little noise H loses its digits to that difference. Where the rows are known and one penalty
// is the identity (F the n x m part of X that it touches, Z the rest, F F' = Q diag(e) Q'):
//   D        diag(1 / (sigma2 + e / lambda)): Q D Q' is the inverse of sigma2 I + F F' / lambda
//   H        = S0 + Z' Q D Q' Z, all its terms positive                                       (3)
// the shared coefficients are s = H^-1 (S0 s0 + Z' Q D Q' y), and with r = y - Z s the others are
// F' Q D Q' r / lambda, the deviance r' Q D Q' r + (s - s0)' S0 (s - s0).                     (4)
#include <algorithm>
#include <numeric>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "interp/reml_structure.hpp"

namespace chaintrue::interp::reml {
namespace {

struct Block {
  Eigen::Index first_column;   // in the problem
  Eigen::Index first_working;  // in working coordinates
  Eigen::MatrixXd basis;       // T
  Eigen::VectorXd weight;      // w
  double balance;              // c
  double log_basis;            // log |T|
  Eigen::MatrixXd coupling;    // C
};

struct Shared {
  std::vector<Eigen::Index> columns;
  Eigen::MatrixXd gram;
  Eigen::MatrixXd prior;
  Eigen::VectorXd mean;
};

/// The rows turned by Q.
struct TurnedRows {
  Eigen::VectorXd eigenvalues;  // e
  Eigen::MatrixXd shared;       // Q' Z
  Eigen::VectorXd response;     // Q' y
  Eigen::MatrixXd to_block;     // T^-1 F' Q
};

class BorderedFactor final : public Factor {
 public:
  BorderedFactor(const std::vector<Block>& blocks,
                 const Shared& shared,
                 const std::optional<TurnedRows>& rows,
                 const Eigen::VectorXd& lambda,
                 double sigma2)
      : blocks_(blocks), shared_(shared), rows_(rows), lambda_(lambda), size_(shared.gram.rows()) {
    const double per_sigma2 = 1.0 / sigma2;
    Eigen::MatrixXd h = per_sigma2 * shared.gram + shared.prior;
    const Eigen::VectorXd before = h.diagonal();
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const Block& block = blocks[k];
      const Eigen::VectorXd a =
          (1.0 - block.weight.array()) * per_sigma2 +
          (lambda(static_cast<Eigen::Index>(k)) / block.balance) * block.weight.array();
      inverse_diagonal_.push_back(a.cwiseInverse());
      beside_.emplace_back((per_sigma2 * inverse_diagonal_.back()).asDiagonal() * block.coupling);
      h.noalias() -= (per_sigma2 * block.coupling.transpose()) * beside_.back();
      log_determinant_ += a.array().log().sum() - 2.0 * block.log_basis;
      size_ += a.size();
    }
    if (rows) {
      inverse_of_rows_ = (sigma2 + rows->eigenvalues.array() / lambda(0)).inverse();
      h = shared.prior;
      h.noalias() += rows->shared.transpose() * (inverse_of_rows_.asDiagonal() * rows->shared);
    }
    positive_ = true;
    if (h.rows() > 0) {
      corner_cholesky_.emplace(h, rows ? Eigen::VectorXd() : before);
      positive_ = corner_cholesky_->positive();
      if (positive_) {
        log_determinant_ += corner_cholesky_->log_determinant();
      }
    }
  }

  [[nodiscard]] bool positive() const { return positive_; }
  [[nodiscard]] double log_determinant() const override { return log_determinant_; }

  [[nodiscard]] std::optional<BestFit> best() const override {  // (4)
    if (!rows_) {
      return std::nullopt;
    }
    const Eigen::Index p = shared_.gram.rows();
    BestFit fit{Eigen::VectorXd(size_), 0.0};
    Eigen::VectorXd residual = rows_->response;
    if (p > 0) {
      const Eigen::VectorXd s = corner_cholesky_->solve(
          shared_.prior * shared_.mean +
          rows_->shared.transpose() * (inverse_of_rows_.asDiagonal() * rows_->response));
      residual.noalias() -= rows_->shared * s;
      fit.coefficients.tail(p) = s;
      fit.deviance = (s - shared_.mean).dot(shared_.prior * (s - shared_.mean));
    }
    const Eigen::VectorXd weighted = inverse_of_rows_.asDiagonal() * residual;
    fit.deviance += residual.dot(weighted);
    fit.coefficients.head(size_ - p).noalias() = rows_->to_block * (weighted / lambda_(0));
    return fit;
  }

  [[nodiscard]] Eigen::MatrixXd solve(const Eigen::MatrixXd& right) const override {
    const Eigen::Index p = shared_.gram.rows();
    Eigen::MatrixXd result(right.rows(), right.cols());
    Eigen::MatrixXd corner = right.bottomRows(p);
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      corner.noalias() -= beside_[k].transpose() * part(right, k);
    }
    if (p > 0) {
      corner = corner_cholesky_->solve(corner);
    }
    result.bottomRows(p) = corner;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      auto mine = result.middleRows(blocks_[k].first_working, blocks_[k].weight.size());
      mine = inverse_diagonal_[k].asDiagonal() * part(right, k);
      mine.noalias() -= beside_[k] * corner;
    }
    return result;
  }

  [[nodiscard]] Traces traces() const override {
    const auto n = static_cast<Eigen::Index>(blocks_.size()) + 1;
    Traces result{Eigen::VectorXd::Zero(n), Eigen::MatrixXd::Zero(n, n)};
    const Eigen::MatrixXd corner =
        corner_cholesky_ ? corner_cholesky_->inverse() : Eigen::MatrixXd();  // H^-1
    std::vector<Eigen::MatrixXd> low_rank;                                   // H^-1 U' D U
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      const Eigen::VectorXd d = (lambda_(i) / blocks_[k].balance) * blocks_[k].weight;
      const Eigen::VectorXd plain = d.cwiseProduct(inverse_diagonal_[k]);
      const Eigen::VectorXd extra =
          d.cwiseProduct((beside_[k] * corner).cwiseProduct(beside_[k]).rowwise().sum());
      result.first(i) = plain.sum() + extra.sum();
      result.second(i, i) = plain.squaredNorm() + 2.0 * plain.dot(extra);
      low_rank.push_back(corner * (beside_[k].transpose() * d.asDiagonal() * beside_[k]));
    }
    low_rank.push_back(corner * shared_.prior);
    result.first(n - 1) = low_rank.back().trace();
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) {
        result.second(i, j) += low_rank[static_cast<std::size_t>(i)]
                                   .cwiseProduct(low_rank[static_cast<std::size_t>(j)].transpose())
                                   .sum();
      }
    }
    return result;
  }

  void add_inverse(double weight, WorkingCovariance& sum) const override {  // (2)
    if (sum.diagonal.size() == 0) {
      sum.diagonal = Eigen::VectorXd::Zero(size_);
    }
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      sum.diagonal.segment(blocks_[k].first_working, blocks_[k].weight.size()) +=
          weight * inverse_diagonal_[k];
    }
    const Eigen::Index p = shared_.gram.rows();
    if (p == 0 || weight == 0.0) {
      return;
    }
    // (I, -U')' H^-1 (I, -U') = W W' with W = (I, -U')' times a root of H^-1.
    const Eigen::MatrixXd root =
        corner_cholesky_->transposed_half_solve(Eigen::MatrixXd::Identity(p, p));
    Eigen::MatrixXd wide(size_, p);
    wide.bottomRows(p) = root;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      wide.middleRows(blocks_[k].first_working, blocks_[k].weight.size()).noalias() =
          -beside_[k] * root;
    }
    sum.roots.push_back({weight, std::move(wide)});
  }

 private:
  [[nodiscard]] Eigen::MatrixXd part(const Eigen::MatrixXd& right, std::size_t k) const {
    return right.middleRows(blocks_[k].first_working, blocks_[k].weight.size());
  }

  const std::vector<Block>& blocks_;
  const Shared& shared_;
  const std::optional<TurnedRows>& rows_;
  Eigen::VectorXd inverse_of_rows_;  // D
  Eigen::VectorXd lambda_;
  Eigen::Index size_;
  std::vector<Eigen::VectorXd> inverse_diagonal_;
  std::vector<Eigen::MatrixXd> beside_;            // U
  std::optional<ScaledCholesky> corner_cholesky_;  // of H; none without shared columns
  double log_determinant_ = 0.0;
  bool positive_ = false;
};

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
    auto result = std::make_unique<BorderedFactor>(blocks_, shared_, rows_, lambda, sigma2);
    if (!result->positive()) {
      return nullptr;
    }
    return result;
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
      // In one go for each sign: a wide product costs less than many narrow ones.
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
  /// The roots whose weights have that sign, each times the root of its weight's size.
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
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(penalised * penalised.transpose());
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
    Eigen::MatrixXd beside(m, static_cast<Eigen::Index>(shared_.columns.size()));
    for (std::size_t i = 0; i < shared_.columns.size(); ++i) {
      beside.col(static_cast<Eigen::Index>(i)) =
          problem.gram.col(shared_.columns[i]).segment(penalty.first_column, m);
    }
    block.coupling = block.basis.transpose() * beside;
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
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(scaled);
    block.weight = solver.eigenvalues().cwiseMax(0.0).cwiseMin(1.0);
    // Eigenvalues come in rising order: the first are the penalty's null space.
    const Eigen::Index nullity = penalty.rank >= 0 ? gram.rows() - penalty.rank : 0;
    block.weight.head(nullity).setZero();
    block.basis = cholesky.transposed_half_solve(solver.eigenvectors());
    block.log_basis = -0.5 * cholesky.log_determinant();
    return true;
  }

  /// (1) where the penalty is the identity: the eigenvectors of G alone do it.
  static bool diagonalise_ridge(const Eigen::MatrixXd& gram, Block& block) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(gram);
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
