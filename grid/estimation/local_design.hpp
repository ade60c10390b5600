// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The design of many readings in sparse form: few unknowns densely, the surface only through the
/// splines at each place. Private to grid/estimation.
///
///   X = D M,   M = diag(I, B, B)                                                              (1)
///   X' w X = M' (D' w D) M,   X_u C X_u' = D_u (M C M') D_u'                                  (2)
///
/// D holds the columns of all unknowns but the penalised ones, and phi(place) for each chain; B turns these
/// into splines (observed_subspace.hpp). A row of D has some 50 entries where one of X has 350: (2)
/// costs n 50^2 + q^3 in place of n q^2, for n rows and q unknowns.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "grid/estimation/linearised_system.hpp"
#include "grid/estimation/observed_subspace.hpp"
#include "grid/estimation/unknowns.hpp"
#include "interp/reml.hpp"

namespace chaintrue::grid::estimation {

/// Units and response are those of the dense design; they must outlive this.
class LocalDesign {
 public:
  /// `marks` are the places of all units, in the surface's frame.
  LocalDesign(const Eigen::MatrixXd& design,
              const std::vector<SystemUnit>& units,
              const Unknowns& unknowns,
              const ObservedSubspace& observed,
              const interp::BsplineBasis& basis,
              const std::vector<model::MarkPoint>& marks);

  /// Worth its cost of q^3 with more rows than this per unknown.
  static constexpr Eigen::Index kRowsForEachUnknown = 4;

  /// Adds X' w X, X' w y, y' w y and the rows of positive weight; a weight for each unit.
  void add_rows(const Eigen::VectorXd& response,
                const Eigen::VectorXd& weights,
                interp::PenalisedProblem& problem) const;
  /// X_u C X_u' of every unit.
  [[nodiscard]] std::vector<Eigen::MatrixXd> spreads(const Eigen::MatrixXd& covariance) const;

 private:
  using Entry = std::pair<Eigen::Index, double>;  ///< column of D, value

  const std::vector<SystemUnit>& units_;
  std::vector<std::vector<Entry>> rows_;  ///< of D
  Eigen::MatrixXd to_unknowns_;           ///< M
};

}  // namespace chaintrue::grid::estimation
