// SPDX-License-Identifier: GPL-3.0-or-later
/// Notation as in the header.
#include "grid/map/reading_covariance.hpp"

#include <algorithm>
#include <cmath>

#include "grid/precondition.hpp"

namespace chaintrue::grid {
namespace {

/// L^-1 of a unit. Throws if the noise is not positive.
Eigen::MatrixXd whitening_of_unit(const Eigen::MatrixXd& own) {
  const linear::Cholesky factor(own);
  if (own.size() == 0 || !factor.is_positive_definite()) {
    throw precondition("{} readings of one unit whose least variance is {:g} mm^2",
                       own.rows(),
                       own.size() > 0 ? own.diagonal().minCoeff() : 0.0);
  }
  return factor.half_solve(Eigen::MatrixXd::Identity(own.rows(), own.cols()));
}

}  // namespace

Eigen::VectorXd ReadingCovariance::diagonal() const {
  Eigen::VectorXd sum = of_map.rowwise().squaredNorm();
  for (Eigen::Index column = 0; column < shared.outerSize(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator at(shared, column); at; ++at)
      sum[at.row()] += at.value() * at.value();
  }
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd& unit : own) {
    sum.segment(row, unit.rows()) += unit.diagonal();
    row += unit.rows();
  }
  return sum;
}

Eigen::MatrixXd ReadingCovariance::dense() const {
  Eigen::MatrixXd sum = linear::outer(of_map);
  sum += Eigen::MatrixXd(shared * shared.transpose());
  Eigen::Index row = 0;
  for (const Eigen::MatrixXd& unit : own) {
    sum.block(row, row, unit.rows(), unit.rows()) += unit;
    row += unit.rows();
  }
  return sum;
}

Eigen::MatrixXd narrowed(const Eigen::MatrixXd& f) {
  if (f.cols() <= f.rows()) return f;
  return linear::covariance_root(linear::outer(f));
}

FactoredCovariance::FactoredCovariance(const ReadingCovariance& covariance) {
  Eigen::Index rows = 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (const Eigen::MatrixXd& own : covariance.own) {
    whitening_.push_back(whitening_of_unit(own));
    const Eigen::MatrixXd& white = whitening_.back();
    for (Eigen::Index i = 0; i < white.rows(); ++i) {
      for (Eigen::Index j = 0; j <= i; ++j) entries.emplace_back(rows + i, rows + j, white(i, j));
      log_root_det_ -= std::log(white(i, i));
    }
    rows += white.rows();
  }
  if (rows != covariance.rows() || rows != covariance.shared.rows()) {
    throw precondition("readings of {} rows in units, {} of shared errors, {} of the map",
                       rows,
                       covariance.shared.rows(),
                       covariance.rows());
  }
  white_.resize(rows, rows);
  white_.setFromTriplets(entries.begin(), entries.end());
  shared_ = white_ * covariance.shared;
  of_map_ = white_ * covariance.of_map;
  factor_ = linear::Cholesky(gram());
  log_root_det_ += 0.5 * factor_.log_det();
}

/// M, its lower half.
Eigen::MatrixXd FactoredCovariance::gram() const {
  const Eigen::Index k = shared_.cols();
  const Eigen::Index m = of_map_.cols();
  Eigen::MatrixXd gram = Eigen::MatrixXd::Identity(k + m, k + m);
  if (k > 0) {
    gram.topLeftCorner(k, k) += Eigen::MatrixXd(shared_.transpose() * shared_);
    gram.bottomLeftCorner(m, k) = (shared_.transpose() * of_map_).transpose();
  }
  gram.bottomRightCorner(m, m) = linear::one_plus_gram(of_map_);
  return gram;
}

/// G' of whitened columns.
Eigen::MatrixXd FactoredCovariance::by_columns(const Eigen::MatrixXd& white) const {
  Eigen::MatrixXd result(columns(), white.cols());
  result.topRows(shared_.cols()) = shared_.transpose() * white;
  result.bottomRows(of_map_.cols()) = linear::product(linear::transposed(of_map_), white);
  return result;
}

Eigen::MatrixXd FactoredCovariance::conditioned(const Eigen::MatrixXd& y) const {
  const Eigen::MatrixXd white = white_ * y;
  const Eigen::MatrixXd z = factor_.solve(by_columns(white));
  Eigen::MatrixXd result(white.rows() + z.rows(), y.cols());
  result.topRows(white.rows()) =
      white - shared_ * z.topRows(shared_.cols()) -
      linear::product(of_map_, z.bottomRows(of_map_.cols()));
  result.bottomRows(z.rows()) = z;
  return result;
}

Eigen::VectorXd FactoredCovariance::pulled(const Eigen::VectorXd& conditioned) const {
  return white_.transpose() * conditioned.head(white_.rows());
}

std::vector<Eigen::MatrixXd> FactoredCovariance::precision_of_units() const {
  // Enough rows for a fast solve, few enough for little memory.
  constexpr std::size_t kUnits = 256;
  std::vector<Eigen::MatrixXd> result;
  result.reserve(whitening_.size());
  Eigen::Index first_row = 0;
  for (std::size_t first = 0; first < whitening_.size(); first += kUnits) {
    const std::size_t end = std::min(first + kUnits, whitening_.size());
    Eigen::Index rows = 0;
    for (std::size_t u = first; u < end; ++u) rows += whitening_[u].rows();
    Eigen::MatrixXd by_row(columns(), rows);
    by_row.topRows(shared_.cols()) =
        Eigen::MatrixXd(shared_.middleRows(first_row, rows)).transpose();
    by_row.bottomRows(of_map_.cols()) = of_map_.middleRows(first_row, rows).transpose();
    const Eigen::MatrixXd solved = factor_.half_solve(by_row);
    Eigen::Index row = 0;
    for (std::size_t u = first; u < end; ++u) {
      const Eigen::MatrixXd& white = whitening_[u];
      const auto own = solved.middleCols(row, white.rows());
      const double prior = by_row.middleCols(row, white.rows()).squaredNorm();
      // The variance of a unit given all other readings is at most its prior variance.
      const linear::SymmetricEigen parts(linear::gram(own));
      const Eigen::VectorXd left = (1.0 - parts.eigenvalues().array()).max(1.0 / (1.0 + prior));
      const Eigen::MatrixXd turned = parts.eigenvectors().transpose() * white;
      result.emplace_back(turned.transpose() * left.asDiagonal() * turned);
      row += white.rows();
    }
    first_row += rows;
  }
  return result;
}

}  // namespace chaintrue::grid
