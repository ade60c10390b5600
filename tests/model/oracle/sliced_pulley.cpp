// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/model/oracle/sliced_pulley.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace chaintrue::model {

SlicedPulley::SlicedPulley(const Dimensions& d) : d_(d) {
  const bool sound = d.gear_radius_mm >= 0.0 && d.pulley_radius_mm > d.gear_radius_mm &&
                     d.centre_distance_mm > d.pulley_radius_mm + d.gear_radius_mm &&
                     std::isfinite(d.centre_distance_mm) && std::isfinite(d.arm_to_corner_rad);
  if (sound) return;
  throw std::invalid_argument(
      fmt::format("pulley_radius_mm {}, gear_radius_mm {}, centre_distance_mm {}, "
                  "arm_to_corner_rad {}: expected finite numbers, a "
                  "gear smaller than the pulley and axes farther apart than both radii",
                  d.pulley_radius_mm,
                  d.gear_radius_mm,
                  d.centre_distance_mm,
                  d.arm_to_corner_rad));
}

double SlicedPulley::critical_angle_rad() const {
  return d_.arm_to_corner_rad -
         std::asin((d_.pulley_radius_mm - d_.gear_radius_mm) / d_.centre_distance_mm);
}

double SlicedPulley::belt_travel_mm(double arm_angle_rad) const {
  const double beyond = critical_angle_rad() - arm_angle_rad;
  if (!(beyond > 0.0)) return 0.0;
  const double big = d_.pulley_radius_mm, small = d_.gear_radius_mm, a = d_.centre_distance_mm;
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

double SlicedPulley::travel_error_mm(double arm_angle_rad) const {
  const double beyond = critical_angle_rad() - arm_angle_rad;
  return beyond > 0.0 ? belt_travel_mm(arm_angle_rad) - d_.pulley_radius_mm * beyond : 0.0;
}

LinearKink SlicedPulley::fit_line(double from_arm_rad, double to_arm_rad, int samples) const {
  if (samples < 2 || from_arm_rad == to_arm_rad) {
    throw std::invalid_argument(
        fmt::format("a line through {} samples from {} to {} rad: expected two or more angles",
                    samples,
                    from_arm_rad,
                    to_arm_rad));
  }
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

double travel_error_ratio(const LinearKink& kink, double travel_per_rad_mm) {
  return kink.slope_mm_per_rad / travel_per_rad_mm;
}

SlicedPulley firepick_delta_pulley() {
  // Gates PowerGrip GT3, 2 mm pitch: pitch line differential 0.254 mm, tooth height 0.75 mm.
  constexpr double kPitchLineAboveTeeth = 0.254 + 0.75;
  return SlicedPulley({.pulley_radius_mm = 47.5 + kPitchLineAboveTeeth,
                       .gear_radius_mm = 16 * 2.0 / (2.0 * std::numbers::pi),
                       .centre_distance_mm = 92.114,
                       .arm_to_corner_rad = -24.17 * std::numbers::pi / 180.0});
}

}  // namespace chaintrue::model
