// SPDX-License-Identifier: GPL-3.0-or-later
#include "grid/estimation/placement_fit.hpp"

#include <Eigen/Cholesky>

namespace chaintrue::grid::estimation {

void PlacementNormal::add_prior(const model::SheetPlacement& at,
                                const observation::SheetPrior& prior) {
  const Eigen::Vector3d sigma(prior.shift_sigma_mm, prior.shift_sigma_mm, prior.rotation_sigma_rad);
  const Eigen::Vector3d precision = sigma.cwiseAbs2().cwiseInverse();
  normal_.diagonal() += precision;
  right_ -= precision.cwiseProduct(Eigen::Vector3d(at.x_mm, at.y_mm, at.rotation_rad));
}

Eigen::Vector3d PlacementNormal::solve() const { return Eigen::LDLT<Eigen::Matrix3d>(normal_).solve(right_); }

model::SheetPlacement fit_placement(const LinearisedAt& linearised,
                                    const std::optional<observation::SheetPrior>& prior) {
  model::SheetPlacement sheet;
  constexpr int kSteps = 8;
  for (int step = 0; step < kSteps; ++step) {
    PlacementNormal sum;
    if (!linearised(sheet, sum)) break;
    if (prior) sum.add_prior(sheet, *prior);
    const Eigen::Vector3d change = sum.solve();
    sheet.x_mm += change[0];
    sheet.y_mm += change[1];
    sheet.rotation_rad += change[2];
  }
  return sheet;
}

}  // namespace chaintrue::grid::estimation
