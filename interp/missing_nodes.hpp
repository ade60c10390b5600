// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Filling the holes of a grid of values so that a tensor surface can be put through it.
///
/// Each hole is filled by the not-a-knot spline along the line (row or column) through it that has
/// more nodes present, holes at the end of a line by its continuation. Meant for what a model
/// leaves over: residuals are smooth at the scale of a cell; raw chain lengths are filled some
/// millimetres wrong next to the motors.

#include <vector>

#include <Eigen/Core>
#include <tl/expected.hpp>

namespace chaintrue::interp {

struct FilledNode {
  Eigen::Index ix;
  Eigen::Index iy;
  double value;
  double doubt;  ///< how far the fill along the other line is off; 0 where there is none
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
