// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Anchors and taped holes at rest: the noise and the displacement that the distances make likeliest, and which
/// distances are rejected. (1) to (3) of belts_and_holes.hpp. Private to grid/belts.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "grid/belts/belt_holes.hpp"
#include "grid/belts/holes_estimate.hpp"
#include "grid/containers.hpp"

namespace chaintrue::grid::belts {

/// Where the fit stands.
struct TapedState {
  FrameState frame;
  TapedRows rows;
  WithoutHoles without_holes;
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
  /// The tape's own and that of what the others predict; what kept a rejected distance from
  /// counting is no part of it.
  [[nodiscard]] double left_out_sigma_mm(Eigen::Index k) const {
    const double added = counting[as_size(k)] ? 0.0 : kRejectedMm2;
    return std::sqrt(1.0 / inverse(k, k) - added);
  }
};

[[nodiscard]] TapedMarginal marginal(const HolesEstimate& frame,
                                     const std::vector<BeltHoles>& sets,
                                     const TapedState& at,
                                     const TapedNoise& noise,
                                     const std::vector<bool>& counting);

/// Empty where it does not converge, or a third of the distances are not enough to reject.
[[nodiscard]] std::optional<TapedState> converged_state(const HolesEstimate& frame,
                                                        const std::vector<BeltHoles>& sets);

}  // namespace chaintrue::grid::belts
