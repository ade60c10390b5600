// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/diagnosis/regressor_columns.hpp"

#include <algorithm>

#include "grid/containers.hpp"
#include "interp/linear_algebra.hpp"
#include "grid/precondition.hpp"

namespace chaintrue::grid::diagnosis {

RegressorColumns::RegressorColumns(Eigen::MatrixXd columns)
    : distinct_(std::move(columns)), count_(distinct_.cols()) {
  for (Eigen::Index k = 0; k < count_; ++k) of_.push_back({k, 1.0});
}

void RegressorColumns::add(const Eigen::VectorXd& column, double factor) {
  if (column.size() != rows()) {
    throw precondition("a column of {} rows among columns of {}", column.size(), rows());
  }
  if (count_ == distinct_.cols()) {
    distinct_.conservativeResize(Eigen::NoChange, std::max<Eigen::Index>(16, 2 * count_));
  }
  distinct_.col(count_) = column;
  of_.push_back({count_, factor});
  ++count_;
}

void RegressorColumns::add_multiple(double factor) {
  if (count_ == 0) throw precondition("{} times the last of no columns", factor);
  of_.push_back({count_ - 1, factor});
}

Eigen::MatrixXd RegressorColumns::dense() const {
  Eigen::MatrixXd result(rows(), cols());
  for (Eigen::Index k = 0; k < cols(); ++k) result.col(k) = col(k);
  return result;
}

Eigen::MatrixXd RegressorColumns::dense(const std::vector<int>& columns) const {
  Eigen::MatrixXd result(rows(), std::ssize(columns));
  for (Eigen::Index k = 0; k < result.cols(); ++k) {
    result.col(k) = col(columns[as_size(k)]);
  }
  return result;
}

RegressorColumns RegressorColumns::subset(const std::vector<Eigen::Index>& columns) const {
  std::vector<Eigen::Index> kept;  // for the distinct columns, in their order
  RegressorColumns result;
  for (const Eigen::Index k : columns) {
    if (kept.empty() || kept.back() != index(k)) kept.push_back(index(k));
    result.of_.push_back({std::ssize(kept) - 1, factor(k)});
  }
  result.distinct_ = distinct_(Eigen::all, kept);
  result.count_ = result.distinct_.cols();
  return result;
}

Eigen::VectorXd RegressorColumns::transpose_times(const Eigen::VectorXd& vector) const {
  const Eigen::VectorXd products = linear::product(linear::transposed(distinct()), vector);
  Eigen::VectorXd result(cols());
  for (Eigen::Index k = 0; k < cols(); ++k) result(k) = factor(k) * products(index(k));
  return result;
}

Eigen::VectorXd RegressorColumns::squared_norms() const {
  const Eigen::VectorXd squares = distinct().colwise().squaredNorm();
  Eigen::VectorXd result(cols());
  for (Eigen::Index k = 0; k < cols(); ++k) result(k) = factor(k) * factor(k) * squares(index(k));
  return result;
}

}  // namespace chaintrue::grid::diagnosis
