// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The residual of the calibrated model: one smooth correction for each chain.
///
///   correction_i(q) = e_i f_i(q) + s_i(q)                                                   (1)
///
///   q    a mark
///   f_i  the model's length of chain i there
///   e_i  a length scale of the chain
///   s_i  cubic B-splines with a thin-plate penalty
///
/// The scale is there because a chain's pitch is never quite nominal, and because a correction that
/// follows the chain's length is a far better guess between and beyond the points than one that
/// knows only x and y.
///
/// Order of the coefficients: settings, e_left, e_right, s_left, s_right (FitColumns).
#pragma once

#include "grid/plane_vectors.hpp"
#include "interp/bspline_basis.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/sheet_placement.hpp"
#include "model/reading_model.hpp"

namespace chaintrue::grid {

/// Where each group of unknowns begins.
struct FitColumns {
  Index settings = 0;  ///< how many settings there are
  Index basis = 0;     ///< coefficients of one spline
  Index scale(Side side) const { return settings + row_of(side); }
  Index spline(Side side) const { return settings + 2 + row_of(side) * basis; }
  Index total() const { return settings + 2 + 2 * basis; }
};

/// Immutable, thread safe.
struct ResidualSurface {
  interp::BsplineBasis basis;
  PerSide<double> scale;
  PerSide<VectorXd> coefficients;

  /// The corrected lengths and d(lengths)/d(mark), from the model's own at the same mark.
  struct Corrected {
    ChainLengths lengths;
    Matrix2d mark_jacobian;
  };
  Corrected apply(MarkPoint mark, ChainLengths lengths, const Matrix2d& mark_jacobian) const;
};

}  // namespace chaintrue::grid
