// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/residual_surface.hpp"

namespace chaintrue::grid {

ResidualSurface::Corrected ResidualSurface::apply(MarkPoint mark, ChainLengths lengths,
                                                  const Matrix2d& mark_jacobian) const {
  Corrected result;
  for (const Side side : kSides) {
    const Index row = row_of(side);
    const auto own = basis.evaluate(coefficients[side], mark.x_mm, mark.y_mm);
    result.lengths[side] = lengths[side] * (1.0 + scale[side]) + own.value;
    result.mark_jacobian.row(row) =
        mark_jacobian.row(row) * (1.0 + scale[side]) + RowVector2d(own.dx, own.dy);
  }
  return result;
}

}  // namespace chaintrue::grid
