// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The domain in which a pose can exist, shared by every kinematics: between the verticals through
/// the sprockets' tangents, below the line between the sprockets, and farther from them than the
/// ring reaches. Notation in equilibrium.hpp.
#pragma once

#include <algorithm>
#include <optional>

#include "model/kinematics.hpp"

namespace chaintrue::model {

/// The numbers that the check needs.
struct DomainLimits {
  PerSide<MotorPosition> motors;
  double sprocket_radius_mm = 0.0;
  double feed_sign = 1.0;
  double ring_radius_mm = 0.0;
};

/// Distance below the line between the sprockets: their axes, or off the bottom their lower common
/// tangent.
inline double depth_below_beam_mm(const DomainLimits& limits, BedPoint p) {
  const MotorPosition &l = limits.motors.left, &r = limits.motors.right;
  const double share = (p.x_mm - l.x_mm) / (r.x_mm - l.x_mm);
  return l.y_mm + share * (r.y_mm - l.y_mm) - p.y_mm +
         std::min(0.0, limits.feed_sign) * limits.sprocket_radius_mm;
}

/// Why there is no pose at the point, if geometry alone decides it. NaN: outside_verticals.
inline std::optional<PoseReason> domain_failure(const DomainLimits& limits, BedPoint p) {
  const double u_left = p.x_mm - limits.motors.left.x_mm;
  const double u_right = limits.motors.right.x_mm - p.x_mm;
  const double r = limits.sprocket_radius_mm;
  if (!(std::min(u_left, u_right) > limits.feed_sign * r)) return PoseReason::outside_verticals;
  if (!(depth_below_beam_mm(limits, p) > 0.0)) return PoseReason::above_sprockets;
  const double reach = r * r + limits.ring_radius_mm * limits.ring_radius_mm;
  const double y_left = limits.motors.left.y_mm - p.y_mm,
               y_right = limits.motors.right.y_mm - p.y_mm;
  if (!(std::min(u_left * u_left + y_left * y_left, u_right * u_right + y_right * y_right) >
        reach)) {
    return PoseReason::link_does_not_fit;
  }
  return std::nullopt;
}

}  // namespace chaintrue::model
