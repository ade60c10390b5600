// SPDX-License-Identifier: GPL-3.0-or-later
// A pulley with a slice cut off: beyond a critical angle the belt does not wind on the round part
// but hangs on the slice's corner, and moves less than a round pulley would move it. The same
// error is the catalogue's angular_kink, as a straight line beyond a knee.
//
// Notation
//   R, r   belt line's radius on the pulley and on the drive gear
//   a      distance of their axes
//   C, Q   the slice's corner, at the critical angle and `beyond` farther
//   S      the drive gear's axis
//   D      the belt's tangent point on the gear
//   l0     straight belt at the critical angle, sqrt(a^2 - (R - r)^2)
//   l      straight belt now, sqrt(|SQ|^2 - r^2)
//   psi    turn of the belt's direction since, which winds r psi more on the gear
//
// Belt travel beyond the critical angle, against R * beyond on a round pulley:
//
//   l - l0 + r psi                                                                          (1)
//
// Source: FirePick Delta wiki, "Sliced Pulley Error" (27 September 2015), which keeps the tangent
// at D fixed; (1) lets it turn.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "model/effects/catalogue.hpp"

namespace chaintrue::model {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

/// A straight line beyond a knee: slope * max(0, angle - knee).
struct LinearKink {
  double slope_mm_per_rad = 0.0;
  double knee_rad = 0.0;
  [[nodiscard]] double operator()(double angle_rad) const {
    return angle_rad > knee_rad ? slope_mm_per_rad * (angle_rad - knee_rad) : 0.0;
  }
};

struct SlicedPulley {
  double pulley_radius_mm = 0.0;  ///< R, of the belt's pitch line
  double gear_radius_mm = 0.0;    ///< r, of the belt's pitch line
  double centre_distance_mm = 0.0;
  /// Arm's angle when the corner's radius lies on the line of centres' normal.
  double arm_to_corner_rad = 0.0;

  /// Arm angle (negative: raised) at which the belt reaches the corner.
  [[nodiscard]] double critical_angle_rad() const {
    return arm_to_corner_rad - std::asin((pulley_radius_mm - gear_radius_mm) / centre_distance_mm);
  }

  /// Belt wound from the critical angle on, by the corner (1); zero before it.
  [[nodiscard]] double belt_travel_mm(double arm_angle_rad) const {
    const double beyond = critical_angle_rad() - arm_angle_rad;
    if (!(beyond > 0.0)) return 0.0;
    const double big = pulley_radius_mm, small = gear_radius_mm, a = centre_distance_mm;
    const double l0 = std::sqrt((a - (big - small)) * (a + (big - small)));
    // From Q to the gear's axis: along the belt's first direction, and away from the pulley's axis.
    const double along = l0 + big * std::sin(beyond);
    const double half = std::sin(0.5 * beyond);
    const double outward = 2.0 * big * half * half - small;
    const double square = along * along + outward * outward;
    const double l = std::sqrt(square - small * small);
    const double psi = std::atan2(outward, along) + std::asin(small / std::sqrt(square));
    return l - l0 + small * psi;
  }

  /// Belt travel less the round pulley's: never positive, zero up to the critical angle.
  [[nodiscard]] double travel_error_mm(double arm_angle_rad) const {
    const double beyond = critical_angle_rad() - arm_angle_rad;
    return beyond > 0.0 ? belt_travel_mm(arm_angle_rad) - pulley_radius_mm * beyond : 0.0;
  }

  /// Least squares line through the error at equally spaced angles, as a kink in the raising angle (-arm angle).
  [[nodiscard]] LinearKink fit_line(double from_arm_rad, double to_arm_rad, int samples) const {
    double angle_mean = 0.0, error_mean = 0.0;
    const auto raised = [&](int i) {
      return -(from_arm_rad + (to_arm_rad - from_arm_rad) * i / (samples - 1));
    };
    for (int i = 0; i < samples; ++i) {
      angle_mean += raised(i) / samples;
      error_mean += travel_error_mm(-raised(i)) / samples;
    }
    double product = 0.0, square = 0.0;
    for (int i = 0; i < samples; ++i) {
      const double x = raised(i) - angle_mean;
      product += x * (travel_error_mm(-raised(i)) - error_mean);
      square += x * x;
    }
    const double slope = product / square;
    return {slope, slope == 0.0 ? angle_mean : angle_mean - error_mean / slope};
  }
};

/// The published dimensions: GT2 belt (pitch line 0.254 mm above its tooth root, teeth 0.75 mm
/// high), 16-tooth gear, pulley 47.5 mm to its bearing surface, axes 92.114 mm apart, corner at arm
/// angle -24.17 degrees. Only with the belt's own height added to the 47.5 mm do they give the
/// published critical angle of -52.3 degrees.
SlicedPulley firepick_delta_pulley() {
  // Gates PowerGrip GT3, 2 mm pitch: pitch line differential 0.254 mm, tooth height 0.75 mm.
  constexpr double kPitchLineAboveTeeth = 0.254 + 0.75;
  return {.pulley_radius_mm = 47.5 + kPitchLineAboveTeeth,
          .gear_radius_mm = 16 * 2.0 / (2.0 * std::numbers::pi),
          .centre_distance_mm = 92.114,
          .arm_to_corner_rad = -24.17 * std::numbers::pi / 180.0};
}

TEST(SlicedPulley, CriticalAngleIsThePublishedOneWithTheBeltsOwnHeight) {
  EXPECT_NEAR(firepick_delta_pulley().critical_angle_rad() / kDegree,
              -52.3,
              0.05);  // published to 0.1 degrees
  // Without the belt's height the published dimensions give an angle 0.7 degrees off.
  const SlicedPulley bare{47.5, 16.0 / std::numbers::pi, 92.114, -24.17 * kDegree};
  EXPECT_NEAR(bare.critical_angle_rad() / kDegree, -51.58, 0.01);
}

TEST(SlicedPulley, BeltMovesAsTheCornersVelocityAlongIt) {
  // An independent derivation of (1): the belt winds by the corner's velocity projected on the
  // belt's own direction, integrated.
  const SlicedPulley pulley = firepick_delta_pulley();
  const double big = pulley.pulley_radius_mm, small = 16.0 / std::numbers::pi, a = 92.114;
  const double l0 = std::sqrt(a * a - (big - small) * (big - small));
  const auto speed = [&](double beyond) {
    // Frame: the belt's first direction towards the gear, and outwards. Corner, its velocity, the
    // gear's axis.
    const double cx = -big * std::sin(beyond), cy = big * std::cos(beyond);
    const double vx = -big * std::cos(beyond), vy = -big * std::sin(beyond);
    const double dx = l0 - cx, dy = (big - small) - cy, d = std::hypot(dx, dy);
    const double direction = std::atan2(dy, dx) + std::asin(small / d);
    return -(vx * std::cos(direction) + vy * std::sin(direction));
  };
  for (const double beyond_deg : {0.5, 5.0, 15.0, 30.0}) {
    const double beyond = beyond_deg * kDegree;
    double integral = 0.0;  // Simpson
    constexpr int kPanels = 200;
    for (int i = 0; i <= kPanels; ++i) {
      const double weight = i == 0 || i == kPanels ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      integral += weight * speed(beyond * i / kPanels) * beyond / kPanels / 3.0;
    }
    // Simpson's h^4 with h = 0.15 degrees: 1e-12 of the travel.
    EXPECT_NEAR(pulley.belt_travel_mm(pulley.critical_angle_rad() - beyond), integral, 1e-10)
        << beyond_deg;
  }
}

TEST(SlicedPulley, ErrorBeginsSmoothlyAndOnlyGrows) {
  const SlicedPulley pulley = firepick_delta_pulley();
  const double critical = pulley.critical_angle_rad();
  EXPECT_EQ(pulley.travel_error_mm(critical), 0.0);
  EXPECT_EQ(pulley.travel_error_mm(critical + 0.5), 0.0);
  EXPECT_EQ(pulley.belt_travel_mm(0.0), 0.0);
  double before = 0.0;
  for (int i = 1; i <= 40; ++i) {
    const double error = pulley.travel_error_mm(critical - 0.01 * i);
    EXPECT_LT(error, before);
    before = error;
  }
  // At the corner the belt still touches the round part: neither slope nor curvature. R x^3 / 6 and
  // the gear's share to leading order.
  EXPECT_NEAR(pulley.travel_error_mm(critical - 0.01), 0.0, 2e-5);
}

// The published line (-0.383 mm a degree from -54.6 degrees, -5 mm at most, ratio -0.38296) cannot
// come from the published dimensions: beyond a corner on the rim the belt loses 0.13 mm at the
// homing angle of -67.2 degrees. Slope, knee and maximum agree with each other; the ratio repeats
// the slope's number although it multiplies it by the belt's travel per degree.
TEST(SlicedPulley, PublishedLineDoesNotFollowFromThePublishedDimensions) {
  const SlicedPulley pulley = firepick_delta_pulley();
  EXPECT_NEAR(pulley.travel_error_mm(-67.2 * kDegree), -0.128, 0.001);
  const LinearKink line = pulley.fit_line(-54.0 * kDegree, -72.0 * kDegree, 181);
  EXPECT_NEAR(line.slope_mm_per_rad * kDegree, -0.0149, 0.0001);  // published: -0.383
  EXPECT_NEAR(line.knee_rad / kDegree, 57.57, 0.01);              // published: 54.6
  EXPECT_NEAR(line.slope_mm_per_rad / pulley.pulley_radius_mm, -0.0176, 0.0001);
  const LinearKink published{-0.383 / kDegree, 54.6 * kDegree};
  EXPECT_NEAR(published(67.2 * kDegree), -4.8, 0.05);
  EXPECT_NEAR(-0.383 * pulley.pulley_radius_mm * kDegree,
              -0.324,
              0.001);  // published as the ratio: -0.38296
}

TEST(SlicedPulley, LineHasTheCataloguesAngularKink) {
  const effects::Effect* effect = effects::find_effect("angular_kink");
  ASSERT_NE(effect, nullptr);
  const LinearKink line = firepick_delta_pulley().fit_line(-54.0 * kDegree, -72.0 * kDegree, 181);
  for (const double angle_deg : {10.0, 57.0, 58.0, 67.2, 80.0}) {
    const effects::LengthState chain{.angle_rad = angle_deg * kDegree};
    const std::array<double, 2> values{line.slope_mm_per_rad, line.knee_rad};
    EXPECT_DOUBLE_EQ(effect->add(chain, values).value, line(angle_deg * kDegree)) << angle_deg;
  }
}

}  // namespace
}  // namespace chaintrue::model
