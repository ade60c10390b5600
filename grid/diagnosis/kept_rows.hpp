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
///   const Eigen::MatrixXd a = kept.of(system.by_setting);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

#include "grid/diagnosis/regressor_columns.hpp"

namespace chaintrue::grid::diagnosis {

struct RegressorSystem;

class KeptRows {
 public:
  /// A unit with rows among those kept.
  struct Unit {
    Eigen::Index at = 0;  ///< position of its first row
    Eigen::Index rows = 0;
    std::size_t unit = 0;
    std::optional<Eigen::RowVector2d> across{};  ///< the kept mix of two rows; absent: all rows
  };

  KeptRows() = default;
  /// `rejected`: a flag for each outlier group of the system (regressor_system.hpp).
  KeptRows(const RegressorSystem& system, const Flags& rejected);
  static KeptRows all(const RegressorSystem& system);

  Eigen::Index size() const { return std::ssize(rows_); }
  /// Numbers in the system, ascending; a row across a direction has the number of its unit's first
  /// row.
  const Rows& rows() const { return rows_; }
  const std::vector<Unit>& units() const { return units_; }
  /// Positions of the rows that belong to these units.
  Rows positions(const Indices& units) const;

  Eigen::VectorXd operator()(const Eigen::VectorXd& all) const;
  Eigen::MatrixXd of(const Eigen::Ref<const Eigen::MatrixXd>& all) const;
  /// The kept part of a block of a unit's rows.
  static Eigen::MatrixXd of_unit(const Unit& unit, const Eigen::MatrixXd& block) {
    return unit.across ? Eigen::MatrixXd(*unit.across * block) : block;
  }

 private:
  static std::size_t index(Eigen::Index row) { return as_size(row); }
  Rows rows_;
  std::vector<Unit> units_;
};

}  // namespace chaintrue::grid::diagnosis
