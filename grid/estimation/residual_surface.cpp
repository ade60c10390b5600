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

Eigen::MatrixXd design_rows(const interp::BsplineBasis& basis,
                            const FitColumns& columns,
                            model::MarkPoint mark,
                            model::ChainLengths lengths,
                            const Eigen::MatrixXd& settings_jacobian) {
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, columns.total());
  rows.leftCols(columns.settings) = settings_jacobian;
  rows(0, columns.scale(Side::left)) = lengths.left_mm;
  rows(1, columns.scale(Side::right)) = lengths.right_mm;
  const interp::BasisSupport support = basis.at(mark.x_mm, mark.y_mm);
  for (std::size_t k = 0; k < support.index.size(); ++k) {
    rows(0, columns.spline(Side::left) + support.index[k]) = support.value[k];
    rows(1, columns.spline(Side::right) + support.index[k]) = support.value[k];
  }
  return rows;
}

}  // namespace chaintrue::grid
