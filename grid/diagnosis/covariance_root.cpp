// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/covariance_root.hpp"

#include <utility>

namespace chaintrue::grid::diagnosis {

CovarianceRoot::CovarianceRoot(const MatrixXd& a) {
  linear::ThinSvd parts = linear::thin_svd(a);
  basis_ = std::move(parts.u);
  log_variance_ = parts.values.array().square().log1p();
}

/// (1 + a^2)^p - 1
VectorXd CovarianceRoot::change(double exponent) const {
  return (exponent * log_variance_).exp() - 1.0;
}

void CovarianceRoot::add_change(Eigen::Ref<MatrixXd> m) const {
  MatrixXd along = linear::inner(basis_, m);
  const VectorXd own = change(-0.5);
  for (const Index k : each_below(along.cols())) along.col(k).array() *= own.array();
  linear::add_product(m, 1.0, basis_, along);
}

MatrixXd CovarianceRoot::explained() const {
  return linear::scaled_columns(basis_, (-change(-1.0)).cwiseSqrt());
}

LowRankNoise::LowRankNoise(MatrixXd a) : a_(std::move(a)), normal_(linear::one_plus_gram(a_)) {}

MatrixXd LowRankNoise::explained() const { return normal_.half_solve(a_.transpose()).transpose(); }

LeaveOut::LeaveOut(const CovarianceRoot& root, const LowRankNoise& noise, const MatrixXd& x)
    : log_det_(root.log_det() + noise.log_det()) {
  const MatrixXd half = noise.half_solve(x);
  inner_ = linear::gram(half);
  weighed_ = root.solve(MatrixXd(half.topRows(x.rows())));
  const MatrixXd of_settings = root.explained();
  const MatrixXd of_columns = root.solve(noise.explained());
  explained_.resize(x.rows(), of_settings.cols() + of_columns.cols());
  explained_ << of_settings, of_columns;
}

LeaveOut::Kept LeaveOut::without(const Rows& out) const {
  Kept kept{inner_, log_det_, {}, weighed_(out, Eigen::all)};
  if (out.empty()) return kept;
  MatrixXd block = MatrixXd::Identity(std::ssize(out), std::ssize(out));
  linear::add_outer(block, -1.0, MatrixXd(explained_(out, Eigen::all)));
  kept.block = linear::Cholesky(std::move(block));
  linear::add_gram(kept.inner, -1.0, kept.block.half_solve(kept.weighed));
  kept.log_det += kept.block.log_det();
  return kept;
}

}  // namespace chaintrue::grid::diagnosis
