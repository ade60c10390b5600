// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The placement of a sheet by weighted least squares (Gauss-Newton) on any readings:
///
///   minimise  sum_i |r_i(t)|^2_(W_i) + |t / sigma|^2,    t = (x_mm, y_mm, rotation_rad)
///
/// \code
///   const auto sheet = fit_placement([&](const model::SheetPlacement& at, PlacementNormal& sum) {
///     for (...) sum.add(residual_at(at), by_placement, weight);   // residual: measured - predicted
///     return true;
///   });
/// \endcode
#pragma once

#include <functional>
#include <optional>

#include "grid/observation/observation.hpp"
#include "interp/eigen.hpp"
#include "model/calibration/sheet_placement.hpp"

namespace chaintrue::grid::estimation {

/// Normal equations of the three unknowns.
struct PlacementNormal {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Vector3d right = Vector3d::Zero();

  /// One reading of both chains: measured less predicted, d(predicted)/d(placement), and the inverse
  /// of its covariance.
  void add(const Vector2d& residual, const Eigen::Matrix<double, 2, 3>& by_placement,
           const Matrix2d& weight) {
    normal += by_placement.transpose() * weight * by_placement;
    right += by_placement.transpose() * weight * residual;
  }
};

/// Adds the readings to the equations about a placement; false if the machine has no pose, which
/// ends the search.
using LinearisedAt = std::function<bool(const SheetPlacement&, PlacementNormal&)>;

/// Eight steps from the identity: a shift of 50 mm and a turn of 0.03 rad converge in four. Without a
/// prior the readings must determine all three unknowns.
SheetPlacement fit_placement(const LinearisedAt& linearised,
                             const std::optional<observation::SheetPrior>& prior = {});

}  // namespace chaintrue::grid::estimation
