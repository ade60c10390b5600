// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/residual_surface.hpp"

namespace chaintrue::grid {

using model::Side;

ResidualSurface::Corrected ResidualSurface::apply(model::MarkPoint mark,
                                                  model::ChainLengths lengths,
                                                  const Eigen::Matrix2d& mark_jacobian) const {
  const auto left = basis.evaluate(coefficients.left, mark.x_mm, mark.y_mm);
  const auto right = basis.evaluate(coefficients.right, mark.x_mm, mark.y_mm);
  Corrected result;
  result.lengths.left_mm = lengths.left_mm * (1.0 + scale.left) + left.value;
  result.lengths.right_mm = lengths.right_mm * (1.0 + scale.right) + right.value;
  result.mark_jacobian.row(0) =
      mark_jacobian.row(0) * (1.0 + scale.left) + Eigen::RowVector2d(left.dx, left.dy);
  result.mark_jacobian.row(1) =
      mark_jacobian.row(1) * (1.0 + scale.right) + Eigen::RowVector2d(right.dx, right.dy);
  return result;
}

}  // namespace chaintrue::grid
