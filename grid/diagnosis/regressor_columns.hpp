// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A matrix whose columns are multiples of fewer: two lost links have twice the effect of one, at
/// each of hundreds of visits. Only distinct columns are stored, so time and memory depend on their
/// number.
///
/// \code
///   RegressorColumns g(rows);
///   g.add(one_link, -1.0);        // column 0
///   g.add_multiple(2.0);          // column 1: 2 one_link
///   const double c = g.col(1).dot(e);
/// \endcode
#pragma once

#include <algorithm>
#include <vector>

#include "grid/containers.hpp"
#include "grid/eigen.hpp"
#include "grid/precondition.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {

/// Some of a system's regressors, by number.
using RegressorSet = std::vector<int>;
/// Positions of rows in a matrix, of columns, and of anything in a list.
using Rows = std::vector<Index>;
using ColumnSet = std::vector<Index>;
using Indices = std::vector<std::size_t>;
/// A flag for each unit or outlier group of a system, or for each point.
using Flags = std::vector<bool>;

class RegressorColumns {
 public:
  RegressorColumns() = default;
  explicit RegressorColumns(Index rows) : distinct_(rows, 0) {}

  /// factor times this.
  void add(const VectorXd& column, double factor = 1.0) {
    if (column.size() != rows()) {
      throw precondition("a column of {} rows among columns of {}", column.size(), rows());
    }
    if (count_ == distinct_.cols()) {
      distinct_.conservativeResize(Eigen::NoChange, std::max<Index>(16, 2 * count_));
    }
    distinct_.col(count_) = column;
    of_.push_back({count_, factor});
    ++count_;
  }

  /// Gives back the room for more: with hundreds of visits as much as all columns.
  void fit() { distinct_.conservativeResize(Eigen::NoChange, count_); }

  /// factor times the last added column.
  void add_multiple(double factor) {
    if (count_ == 0) throw precondition("{} times the last of no columns", factor);
    of_.push_back({count_ - 1, factor});
  }

  /// Column k is factor(k) times column index(k) of these.
  auto distinct() const { return distinct_.leftCols(count_); }
  Index index(Index k) const { return of_[as_size(k)].index; }
  double factor(Index k) const { return of_[as_size(k)].factor; }
  Index rows() const { return distinct_.rows(); }
  Index cols() const { return std::ssize(of_); }
  auto col(Index k) const { return distinct_.col(index(k)) * factor(k); }

  /// rows() x columns.size()
  MatrixXd dense(const RegressorSet& columns) const {
    MatrixXd result(rows(), std::ssize(columns));
    for (Index k = 0; k < result.cols(); ++k) {
      result.col(k) = col(columns[as_size(k)]);
    }
    return result;
  }

  RegressorColumns subset(const ColumnSet& columns) const {
    ColumnSet kept;  // for the distinct columns, in their order
    RegressorColumns result;
    for (const Index k : columns) {
      if (kept.empty() || kept.back() != index(k)) kept.push_back(index(k));
      result.of_.push_back({std::ssize(kept) - 1, factor(k)});
    }
    result.distinct_ = distinct_(Eigen::all, kept);
    result.count_ = result.distinct_.cols();
    return result;
  }

  /// cols() x columns of m: inner products of every column with those of a matrix, or with a vector.
  template <class M>
  linear::Like<M> transpose_times(const M& m) const {
    const linear::Like<M> products = linear::product(linear::transposed(distinct()), m);
    linear::Like<M> result(cols(), m.cols());
    for (Index column = 0; column < m.cols(); ++column) {
      for (Index k = 0; k < cols(); ++k) result(k, column) = factor(k) * products(index(k), column);
    }
    return result;
  }

  /// cols(): squared lengths of a map of every column.
  template <class Map>
  VectorXd squared_norms(const Map& map) const {
    VectorXd squares(count_);
    for (Index k = 0; k < count_; ++k) squares(k) = map(VectorXd(distinct_.col(k))).squaredNorm();
    VectorXd result(cols());
    for (Index k = 0; k < cols(); ++k) result(k) = factor(k) * factor(k) * squares(index(k));
    return result;
  }

 private:
  struct Multiple {
    Index index = 0;
    double factor = 1.0;
  };
  MatrixXd distinct_;  ///< with room for more
  Index count_ = 0;
  std::vector<Multiple> of_;
};

}  // namespace chaintrue::grid::diagnosis
