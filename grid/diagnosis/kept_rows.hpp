// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The rows of a system that remain after rejecting some outlier groups: all rows of a unit, none,
/// or, where one direction of a unit's two rows is rejected, the row across it.
///
///   kept = P all,   P = 1 in the rows of a unit that is kept, a' (a across the direction) in one row
///
/// \code
///   const KeptRows kept(system, rejected);
///   const Eigen::VectorXd e = kept(system.e);
///   const Eigen::MatrixXd a = kept(system.by_setting);
/// \endcode
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "grid/containers.hpp"
#include "interp/eigen.hpp"
#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::diagnosis {

struct RegressorSystem;

class KeptRows {
 public:
  /// A unit with rows among those kept.
  struct Unit {
    Index at = 0;  ///< position of its first row
    Index rows = 0;
    std::size_t unit = 0;
    std::optional<RowVector2d> across{};  ///< the kept mix of two rows; absent: all rows
  };

  KeptRows() = default;
  /// `rejected`: a flag for each outlier group of the system (regressor_system.hpp).
  KeptRows(const RegressorSystem& system, const Flags& rejected);

  Index size() const { return std::ssize(rows_); }
  /// Numbers in the system, ascending; a row across a direction has the number of its unit's first
  /// row.
  const Rows& rows() const { return rows_; }
  const std::vector<Unit>& units() const { return units_; }
  /// Positions of the rows that belong to these units.
  Rows positions(const Indices& units) const;

  /// Returns P times a vector or a matrix.
  template <class M>
  linear::Like<M> operator()(const M& all) const {
    linear::Like<M> kept = all(rows_, Eigen::all);
    for (const Unit& unit : units_) {
      if (unit.across)
        kept.row(unit.at) = *unit.across * all.template middleRows<2>(rows_[index(unit.at)]);
    }
    return kept;
  }
  /// Returns P' times the kept rows: all rows, with zeros where none is kept.
  template <class M>
  linear::Like<M> spread(const M& kept) const {
    linear::Like<M> all = linear::Like<M>::Zero(all_, kept.cols());
    all(rows_, Eigen::all) = kept;
    for (const Unit& unit : units_) {
      if (unit.across)
        all.template middleRows<2>(rows_[index(unit.at)]) =
            unit.across->transpose() * kept.row(unit.at);
    }
    return all;
  }

 private:
  static std::size_t index(Index row) { return as_size(row); }
  Index all_ = 0;
  Rows rows_;
  std::vector<Unit> units_;
};

}  // namespace chaintrue::grid::diagnosis
