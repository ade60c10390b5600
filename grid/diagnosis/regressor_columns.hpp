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

#include <Eigen/Core>
#include <vector>

#include "grid/containers.hpp"

namespace chaintrue::grid::diagnosis {

class RegressorColumns {
 public:
  RegressorColumns() = default;
  explicit RegressorColumns(Eigen::Index rows) : distinct_(rows, 0) {}
  /// Each column separately.
  RegressorColumns(Eigen::MatrixXd columns);  // NOLINT(google-explicit-constructor): it is a matrix

  /// factor times this.
  void add(const Eigen::VectorXd& column, double factor = 1.0);
  /// factor times the last added column.
  void add_multiple(double factor);

  /// Column k is factor(k) times column index(k) of these.
  [[nodiscard]] auto distinct() const { return distinct_.leftCols(count_); }
  [[nodiscard]] Eigen::Index rows() const { return distinct_.rows(); }
  [[nodiscard]] Eigen::Index cols() const { return std::ssize(of_); }
  [[nodiscard]] auto col(Eigen::Index k) const { return distinct_.col(index(k)) * factor(k); }
  /// Some rows of a column.
  [[nodiscard]] Eigen::VectorXd column(const std::vector<Eigen::Index>& rows,
                                       Eigen::Index k) const {
    return distinct_.col(index(k))(rows) * factor(k);
  }
  /// rows() x cols()
  [[nodiscard]] Eigen::MatrixXd dense() const;
  /// rows() x columns.size()
  [[nodiscard]] Eigen::MatrixXd dense(const std::vector<int>& columns) const;
  [[nodiscard]] RegressorColumns subset(const std::vector<Eigen::Index>& columns) const;
  /// Applies a linear map to all columns: `map` takes and returns a matrix of as many columns.
  template <typename Map>
  [[nodiscard]] RegressorColumns mapped(const Map& map) const {
    RegressorColumns result;
    result.distinct_ = map(distinct_.leftCols(count_));
    result.count_ = count_;
    result.of_ = of_;
    return result;
  }

  /// cols(): inner products of every column with a vector.
  [[nodiscard]] Eigen::VectorXd transpose_times(const Eigen::VectorXd& vector) const;
  /// cols()
  [[nodiscard]] Eigen::VectorXd squared_norms() const;

  [[nodiscard]] Eigen::Index index(Eigen::Index k) const { return of_[as_size(k)].index; }
  [[nodiscard]] double factor(Eigen::Index k) const { return of_[as_size(k)].factor; }

 private:
  struct Multiple {
    Eigen::Index index = 0;
    double factor = 1.0;
  };
  Eigen::MatrixXd distinct_;  ///< with room for more
  Eigen::Index count_ = 0;
  std::vector<Multiple> of_;
};

}  // namespace chaintrue::grid::diagnosis
