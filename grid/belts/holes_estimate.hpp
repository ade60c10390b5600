// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors and scale between their belts and the tape: the distances of all sets about one state,
/// their covariance, and the minimum of (1) of belts_and_holes.hpp by the one estimator. Private to
/// grid/belts.
#pragma once

#include <optional>
#include <vector>

#include "grid/belts/fit_diagnostics.hpp"
#include "grid/belts/hole_distances.hpp"

namespace chaintrue::grid::belts {

/// Added to the variance of a rejected distance, mm^2: a sigma of ten metres, so that it has no
/// weight.
inline constexpr double kRejectedMm2 = 1e8;

/// Size and reach of the displacement, and the factor on the stated noise.
struct TapedNoise {
  double factor = 1.0;
  double size_mm = 0.0;  ///< 0: no displacement
  double reach_mm = 1.0;
};

/// C of the rows of these sets, with rejected distances given no weight.
[[nodiscard]] Eigen::MatrixXd taped_covariance(const std::vector<BeltHoles>& sets,
                                               const TapedRows& rows,
                                               const TapedNoise& noise,
                                               const std::vector<bool>& counting);

/// Anchors and scale as known without the holes, about a state.
struct WithoutHoles {
  Eigen::MatrixXd covariance;          ///< S_b, 6 x 6
  std::optional<FitDiagnostics> view;  ///< none without points
};

/// Replaces the covariance of anchors and log scale from the readings: S_b of a fit that allows for
/// causes.
using KnownFrame = std::optional<Eigen::MatrixXd>;

class HolesEstimate {
 public:
  /// `belts` and `sets` must outlive this. `alone` is the fit of the belts alone or, without
  /// points, the stated anchors. `known` is 6 x 6 and about `alone`.
  HolesEstimate(const MeasuredBelts& belts,
                const std::vector<BeltHoles>& sets,
                AnchorFit alone,
                KnownFrame known = std::nullopt);

  [[nodiscard]] WithoutHoles without_holes(const FrameState& state) const;
  /// r_b.
  [[nodiscard]] Eigen::VectorXd about_the_belts(const TapedRows& rows,
                                                const FrameState& state) const;
  /// The minimum nearest to `state` with this C; empty where it does not converge.
  [[nodiscard]] std::optional<FrameState> converged(const FrameState& state,
                                                    const Eigen::MatrixXd& covariance) const;
  [[nodiscard]] const AnchorFit& alone() const { return alone_; }

 private:
  [[nodiscard]] std::optional<FrameState> converged_about_known(
      FrameState state, const Eigen::MatrixXd& covariance) const;

  const MeasuredBelts& belts_;
  const std::vector<BeltHoles>& sets_;
  AnchorFit alone_;
  KnownFrame known_;
};

}  // namespace chaintrue::grid::belts
