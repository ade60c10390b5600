// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The converged anchors and taped holes: the likeliest noise and displacement, and the rejected
/// distances. (1) to (3) of belts_and_holes.hpp. Private to grid/belts.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <vector>

#include "grid/belts/belt_holes.hpp"
#include "grid/containers.hpp"

namespace chaintrue::grid::belts {

/// The prior without the holes: x_b and S_b (6 x 6).
struct KnownFrame {
  FrameState state;
  Eigen::MatrixXd covariance;
};

/// The state of the fit. The places of belts' points are not moved.
struct TapedState {
  FrameState frame;
  TapedRows rows;
  TapedNoise noise;
  std::vector<bool> counting;
};

/// (2) and (3) about a state.
struct TapedMarginal {
  Eigen::VectorXd residual_mm;  ///< r_b
  Eigen::MatrixXd inverse;      ///< V^-1
  double log_likelihood = 0.0;
  std::vector<bool> counting;

  [[nodiscard]] double left_out_mm(Eigen::Index k) const {
    return (inverse.row(k) * residual_mm)(0) / inverse(k, k);
  }
  /// The tape's variance plus that of the prediction, without what was added for rejection.
  [[nodiscard]] double left_out_sigma_mm(Eigen::Index k) const {
    const double added = counting[as_size(k)] ? 0.0 : kRejectedMm2;
    return std::sqrt(1.0 / inverse(k, k) - added);
  }
};

[[nodiscard]] TapedMarginal marginal(const KnownFrame& known, const TapedState& at);

/// Empty if it does not converge, or if rejecting a third of the distances is not enough.
[[nodiscard]] std::optional<TapedState> converged_state(const KnownFrame& known,
                                                        const std::vector<BeltHoles>& sets);

}  // namespace chaintrue::grid::belts
