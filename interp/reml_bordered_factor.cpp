// SPDX-License-Identifier: GPL-3.0-or-later
// Notation and equations as in the header.
#include "interp/reml_bordered.hpp"

namespace chaintrue::interp::reml {
namespace {

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
      scaled_coupling_.emplace_back((per_sigma2 * inverse_diagonal_.back()).asDiagonal() * block.coupling);
      h.noalias() -= (per_sigma2 * block.coupling.transpose()) * scaled_coupling_.back();
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
      corner.noalias() -= scaled_coupling_[k].transpose() * part(right, k);
    }
    if (p > 0) {
      corner = corner_cholesky_->solve(corner);
    }
    result.bottomRows(p) = corner;
    for (std::size_t k = 0; k < blocks_.size(); ++k) {
      auto mine = result.middleRows(blocks_[k].first_working, blocks_[k].weight.size());
      mine = inverse_diagonal_[k].asDiagonal() * part(right, k);
      mine.noalias() -= scaled_coupling_[k] * corner;
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
          d.cwiseProduct((scaled_coupling_[k] * corner).cwiseProduct(scaled_coupling_[k]).rowwise().sum());
      result.first(i) = plain.sum() + extra.sum();
      result.second(i, i) = plain.squaredNorm() + 2.0 * plain.dot(extra);
      low_rank.push_back(corner * (scaled_coupling_[k].transpose() * d.asDiagonal() * scaled_coupling_[k]));
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
          -scaled_coupling_[k] * root;
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
  std::vector<Eigen::MatrixXd> scaled_coupling_;            // U
  std::optional<ScaledCholesky> corner_cholesky_;  // of H; none without shared columns
  double log_determinant_ = 0.0;
  bool positive_ = false;
};

}  // namespace

std::unique_ptr<Factor> make_bordered_factor(const std::vector<Block>& blocks,
                                             const Shared& shared,
                                             const std::optional<TurnedRows>& rows,
                                             const Eigen::VectorXd& lambda,
                                             double sigma2) {
  auto factor = std::make_unique<BorderedFactor>(blocks, shared, rows, lambda, sigma2);
  if (!factor->positive()) {
    return nullptr;
  }
  return factor;
}

}  // namespace chaintrue::interp::reml
