// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/leave_out.hpp"

namespace chaintrue::grid::diagnosis {

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
