// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/sliced_pulley.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "model/effects/catalogue.hpp"

namespace chaintrue::model {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

TEST(SlicedPulley, CriticalAngleIsThePublishedOneWithTheBeltsOwnHeight) {
  EXPECT_NEAR(firepick_delta_pulley().critical_angle_rad() / kDegree,
              -52.3,
              0.05);  // published to 0.1 degrees
  // Without the belt's height the published dimensions give an angle 0.7 degrees off.
  const SlicedPulley bare({47.5, 16.0 / std::numbers::pi, 92.114, -24.17 * kDegree});
  EXPECT_NEAR(bare.critical_angle_rad() / kDegree, -51.58, 0.01);
}

TEST(SlicedPulley, BeltMovesAsTheCornersVelocityAlongIt) {
  // An independent derivation of (1): the belt winds by the corner's velocity projected on the
  // belt's own direction, integrated.
  const SlicedPulley pulley = firepick_delta_pulley();
  const double big = pulley.travel_per_rad_mm(), small = 16.0 / std::numbers::pi, a = 92.114;
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
  EXPECT_NEAR(travel_error_ratio(line, pulley.travel_per_rad_mm()), -0.0176, 0.0001);
  const LinearKink published{-0.383 / kDegree, 54.6 * kDegree};
  EXPECT_NEAR(published(67.2 * kDegree), -4.8, 0.05);
  EXPECT_NEAR(-0.383 * pulley.travel_per_rad_mm() * kDegree,
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

TEST(SlicedPulley, RefusesImpossibleDimensions) {
  EXPECT_THROW(SlicedPulley({47.5, 60.0, 92.0, 0.0}),
               std::invalid_argument);  // gear larger than the pulley
  EXPECT_THROW(SlicedPulley({47.5, 5.0, 50.0, 0.0}), std::invalid_argument);  // axes too close
  EXPECT_THROW(SlicedPulley({std::numeric_limits<double>::quiet_NaN(), 5.0, 90.0, 0.0}),
               std::invalid_argument);
  EXPECT_THROW(std::ignore = firepick_delta_pulley().fit_line(-1.0, -1.0, 5),
               std::invalid_argument);
}

}  // namespace
}  // namespace chaintrue::model
