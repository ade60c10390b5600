// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Filling the holes of a grid of values so that a tensor surface can be put through it.
///
/// R f and C f being what the not-a-knot splines along the row and along the column through a hole
/// say of it (holes at the end of a line: their continuation), the hole is filled with
///
///     R f + C f - R C f                                                                     (1)
///
/// the blending of W. Gordon (SIAM J. Numer. Anal. 8 (1971) 158-177): its error (1 - R)(1 - C) f is
/// that of one line predicting the error of the other, none for g(x) + h(y). Where another hole
/// leaves R C f open, the line with more nodes present decides alone. Meant for what a model leaves
/// over: residuals are smooth at the scale of a cell; raw chain lengths are filled some millimetres
/// wrong next to the motors.

#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

namespace chaintrue::interp {

struct FilledNode {
  Eigen::Index ix;
  Eigen::Index iy;
  double value;
  double doubt;    ///< how far the nearer of two lines is off; by one line: 0
  double by_line;  ///< what the line with more nodes present says alone
};

struct FilledGrid {
  Eigen::MatrixXd values;
  std::vector<FilledNode> filled;
};

/// A hole with fewer than three present nodes in its row and in its column.
struct UnfillableNode {
  Eigen::Index ix;
  Eigen::Index iy;
};

/// `values(ix, iy)`, NaN where missing. Throws std::invalid_argument where the shape does not fit
/// the axes. Deterministic: holes are filled from present nodes only, so their order does not
/// matter.
[[nodiscard]] tl::expected<FilledGrid, UnfillableNode> fill_missing(
    const std::vector<double>& x_nodes,
    const std::vector<double>& y_nodes,
    const Eigen::Ref<const Eigen::MatrixXd>& values);

}  // namespace chaintrue::interp
