// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// Fills the missing nodes (holes) of a grid so that a tensor surface can be fitted to it.
///
/// With R f and C f the values at a hole of the not-a-knot splines along its row and along its
/// column (continued to holes at the end of a line), the hole is filled with
///
///     R f + C f - R C f                                                                     (1)
///
/// the blending of W. Gordon (SIAM J. Numer. Anal. 8 (1971) 158-177): its error (1 - R)(1 - C) f is
/// the error of one line in predicting the error of the other, zero for g(x) + h(y). Where another
/// hole leaves R C f undefined, the line with more nodes present is used alone. Meant for residuals
/// of a model, which are smooth at the scale of a cell; raw chain lengths are filled with errors of
/// some millimetres next to the motors.

#include <optional>
#include <vector>

#include "interp/eigen.hpp"

namespace chaintrue::interp {

struct FilledNode {
  Index ix, iy;
  double doubt;    ///< error of the nearer of the two lines; 0 if filled by one line
  double by_line;  ///< value of the line with more nodes present
};

struct FilledGrid {
  MatrixXd values;
  std::vector<FilledNode> filled;
};

/// `values(ix, iy)`, NaN where missing. Empty if a hole has fewer than three present nodes in its
/// row and in its column. Throws std::invalid_argument if the shape does not fit the axes.
/// Deterministic: holes are filled from present nodes only, so their order does not matter.
std::optional<FilledGrid> fill_missing(const std::vector<double>& x_nodes,
                                       const std::vector<double>& y_nodes,
                                       const Eigen::Ref<const MatrixXd>& values);

}  // namespace chaintrue::interp
