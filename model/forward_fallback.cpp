// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/forward_fallback.hpp"

#include <algorithm>
#include <cmath>

#include "model/chain_formulas.hpp"

namespace chaintrue::model {
namespace {

/// Intersection, below the beam, of circles about the axes.
CircleGuess intersect(const PerSide<MotorPosition>& motors, double left_mm, double right_mm) {
  const double dx = motors.right.x_mm - motors.left.x_mm, dy = motors.right.y_mm - motors.left.y_mm;
  const double span = std::sqrt(dx * dx + dy * dy);
  const double along = 0.5 * (span + (left_mm - right_mm) * (left_mm + right_mm) / span);
  const double square = (left_mm - along) * (left_mm + along);
  CircleGuess guess;
  guess.circles_meet = square > 0.0;
  guess.hopeless = !(1.2 * (left_mm + right_mm) > span);  // also true for NaN
  // Chains that do not meet are drawn taut just below the beam: a hundredth of the spacing.
  const double share = guess.circles_meet ? along / span : left_mm / (left_mm + right_mm);
  const double below = guess.circles_meet ? std::sqrt(square) : 0.01 * span;
  guess.point = {motors.left.x_mm + share * dx + below * dy / span,
                 motors.left.y_mm + share * dy - below * dx / span};
  return guess;
}

/// Moves a point into the open domain, so that the next inverse exists.
BedPoint pulled_inside(const DomainLimits& limits, BedPoint p) {
  const double margin = 0.001 * (limits.motors.right.x_mm - limits.motors.left.x_mm);
  const double edge = std::max(0.0, limits.feed_sign) * limits.sprocket_radius_mm + margin;
  p.x_mm = std::clamp(p.x_mm, limits.motors.left.x_mm + edge, limits.motors.right.x_mm - edge);
  const double depth = depth_below_beam_mm(limits, p);
  if (depth < margin) p.y_mm -= margin - depth;
  return p;
}

double miss_mm(const Pose& pose, ChainLengths lengths) {
  return std::hypot(lengths.left_mm - pose.lengths.left_mm,
                    lengths.right_mm - pose.lengths.right_mm);
}

}  // namespace

CircleGuess circle_guess(const DomainLimits& limits, ChainLengths lengths) {
  const double r = limits.sprocket_radius_mm, rho = limits.ring_radius_mm;
  CircleGuess guess = intersect(limits.motors, lengths.left_mm + rho, lengths.right_mm + rho);
  // The wrap at the guess's own angle is subtracted from the length; two passes leave under a
  // micrometre of it.
  for (int pass = 0; pass < 2; ++pass) {
    const BedPoint p = pulled_inside(limits, guess.point);
    const auto l = straight_chain(p.x_mm - limits.motors.left.x_mm,
                                  limits.motors.left.y_mm - p.y_mm, r, limits.feed_sign);
    const auto q = straight_chain(limits.motors.right.x_mm - p.x_mm,
                                  limits.motors.right.y_mm - p.y_mm, r, limits.feed_sign);
    const double left = lengths.left_mm + rho - l.wrap_mm;
    const double right = lengths.right_mm + rho - q.wrap_mm;
    guess =
        intersect(limits.motors, std::sqrt(left * left + r * r), std::sqrt(right * right + r * r));
  }
  guess.point = pulled_inside(limits, guess.point);
  guess.hopeless = guess.hopeless || !(lengths.left_mm > 0.0 && lengths.right_mm > 0.0 &&
                                       std::isfinite(lengths.left_mm + lengths.right_mm));
  return guess;
}

PoseResult forward_by_inverse(const Kinematics& kinematics, const DomainLimits& limits,
                              ChainLengths lengths) {
  constexpr int kMaxSteps = 60;
  constexpr double kConvergedMm = 1e-7;  // Newton is quadratic: one more step reaches rounding
  const CircleGuess guess = circle_guess(limits, lengths);
  if (guess.hopeless) return tl::unexpected(PoseReason::too_short);
  const auto failure = [&] {
    return tl::unexpected(guess.circles_meet ? PoseReason::not_converged : PoseReason::too_short);
  };
  PoseResult pose = kinematics.inverse(guess.point);
  // A light sled's far chain may have no solution at the guess; the middle below the beam always
  // has one.
  if (!pose) {
    const MotorPosition &l = limits.motors.left, &r = limits.motors.right;
    pose = kinematics.inverse(
        {0.5 * (l.x_mm + r.x_mm), 0.5 * (l.y_mm + r.y_mm) - 0.3 * (r.x_mm - l.x_mm)});
  }
  for (int n = 0; pose && n < kMaxSteps; ++n) {
    const double miss = miss_mm(*pose, lengths);
    const bool last = miss < kConvergedMm;
    const Eigen::Matrix2d j = kinematics.jacobian(*pose);
    const double per_det = 1.0 / (j(0, 0) * j(1, 1) - j(0, 1) * j(1, 0));
    const double bl = lengths.left_mm - pose->lengths.left_mm;
    const double br = lengths.right_mm - pose->lengths.right_mm;
    const double dx = per_det * (j(1, 1) * bl - j(0, 1) * br);
    const double dy = per_det * (j(0, 0) * br - j(1, 0) * bl);
    PoseResult next = tl::unexpected(PoseReason::not_converged);
    // Halve until the point has a pose and is closer.
    for (double share = 1.0; share > 1e-6; share *= 0.5) {
      next =
          kinematics.inverse({pose->position.x_mm + share * dx, pose->position.y_mm + share * dy});
      if (next && miss_mm(*next, lengths) < miss) break;
      next = tl::unexpected(PoseFailure(PoseReason::not_converged));
      if (last) return pose;  // at the level of rounding no step comes closer
    }
    if (!next) return failure();
    next->iterations += pose->iterations;
    pose = next;
    if (last) return pose;
  }
  return failure();
}

}  // namespace chaintrue::model
