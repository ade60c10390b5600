// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The linear part of a fit of distances: (1) and (2) of holes_fit.hpp at one linearisation, with
/// the noise that has the greatest posterior. Private to grid/holes.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "grid/holes/hole_marks.hpp"
#include "grid/holes/holes_fit.hpp"

namespace chaintrue::grid {

/// Readings seen from one linearisation.
struct LinearHoles {
  const MeasuredHoles& set;
  const HoleMarks::View& view;
  /// du/dv applied to the design: by the unknowns that are not free directions of the sheet.
  Eigen::MatrixXd by_unknown;
  Eigen::VectorXd response;  ///< readings less what the prior's mean predicts
  Eigen::VectorXd weights;   ///< 0: set aside, below 1: softened
};

/// What a fit found at its last pass.
struct HolesSolution {
  Eigen::VectorXd change;      ///< b, by v
  Eigen::MatrixXd covariance;  ///< of v
  Eigen::VectorXd left_out;    ///< (2), every reading
  Eigen::VectorXd left_out_sigma;
  Eigen::VectorXd hole_shift;  ///< what the holes' own error is found to be, 2 N
  std::vector<FoundHook> hooks;
  double noise2 = 1.0;  ///< s^2
  double log_evidence = 0.0;
};

/// Rows that are not set aside.
[[nodiscard]] std::vector<Eigen::Index> used_rows(const Eigen::VectorXd& weights);

[[nodiscard]] HolesSolution solve_holes(const LinearHoles& holes, const Eigen::MatrixXd& prior);

}  // namespace chaintrue::grid
