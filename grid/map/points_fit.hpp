// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The joint estimate (grid/estimation) of points with their chain lengths alone: what a map of
/// points is assembled from.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/estimation/estimate.hpp"
#include "grid/observation/chain_lengths.hpp"
#include "grid/observation/length_points.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid {

struct PointsFitInput {
  model::Machine machine;  ///< as stated
  std::vector<LengthPoint> points;
  observation::PointNoise noise;
  interp::NoiseScale noise_scale;
  std::optional<SheetUncertainty> sheet;
  std::vector<ExtraReading> readings;  ///< of the settings
  interp::Rectangle domain;
  /// Order of the derivatives that the surfaces' penalty squares: 2, a thin plate, or 3, smoother
  /// still.
  int bending_order = 2;
  /// Is told of `step` at each pass.
  Progress progress{};
  WorkStep step{"settings and correction"};
};

/// One point after the fit.
struct FittedPoint {
  LengthPoint point;
  bool bad = false;
  double distance = 0.0;  ///< of the left-out residual, in sigmas
  /// Measured minus predicted, in the chains.
  Eigen::Vector2d residual_mm;           ///< of the finished map
  Eigen::Vector2d left_out_residual_mm;  ///< of a map made without this point
  Eigen::Vector2d blocked_residual_mm;   ///< of a map made without its part of the bed
  Eigen::Matrix2d mark_jacobian;         ///< d(lengths)/d(mark)
};

struct PointsFit {
  estimation::Estimate estimate;
  std::vector<FittedPoint> points;  ///< in the order of the input's
  [[nodiscard]] const model::SheetPlacement& sheet() const {
    return estimate.observations.front().sheet;
  }
};

/// Points as an observation, in their order.
[[nodiscard]] observation::ChainLengthReadings chain_length_readings(
    const std::vector<LengthPoint>& points,
    observation::PointNoise noise,
    double noise_dof,
    const std::optional<SheetUncertainty>& sheet);

/// What an estimate says of the points that are its observation of that number.
[[nodiscard]] std::vector<FittedPoint> fitted_points(const std::vector<LengthPoint>& points,
                                                     const estimation::Estimate& estimate,
                                                     std::size_t observation);

[[nodiscard]] tl::expected<PointsFit, estimation::EstimationFailure> fit_points(
    const PointsFitInput& input);

/// `fit` with settings and chain scales by least squares alone, for a surface that passes through
/// every point: with the machine, sheet and scales that minimise
///
///   sum over good points |y - (1 + e) f(theta)|^2 / s^2 + |theta / sigma|^2 + |e / kScaleSigma|^2
///
/// with s, the size of what is left, by restricted maximum likelihood.
///
/// The joint fit weighs a setting against the bend of the surface that would replace it: right for
/// naming settings, but what it leaves to the surface need not be small. A surface through all the
/// nodes errs between them in proportion to what it has to carry, so for it the settings are those
/// that leave least at the nodes. For machines whose lengths err by 0.8 mm more than any model says
/// that lowers the largest error between 4 x 7 to 7 x 13 nodes by a fifth to a half.
///
/// Covariances of the settings and scales grow by the square of what they moved: the joint fit's
/// estimate remains the best one of the settings themselves. Unchanged where the least squares fail.
[[nodiscard]] PointsFit with_plain_calibration(const PointsFitInput& input, PointsFit fit);

}  // namespace chaintrue::grid
