// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/placement_fit.hpp"

#include "interp/linear_algebra.hpp"

namespace chaintrue::grid::estimation {

SheetPlacement fit_placement(const LinearisedAt& linearised,
                             const std::optional<observation::SheetPrior>& prior) {
  Vector3d precision = Vector3d::Zero();
  if (prior) precision = prior->sigma().cwiseAbs2().cwiseInverse();
  Vector3d at = Vector3d::Zero();
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    PlacementNormal sum;
    if (!linearised({at.x(), at.y(), at.z()}, sum)) break;
    sum.normal.diagonal() += precision;
    at += linear::PivotedCholesky(sum.normal).solve(sum.right - precision.cwiseProduct(at));
  }
  return {at.x(), at.y(), at.z()};
}

}  // namespace chaintrue::grid::estimation
