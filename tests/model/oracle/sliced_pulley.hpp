// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A pulley with a slice cut off: beyond a critical angle the belt does not wind on the round part
/// but hangs on the slice's corner, and moves less than a round pulley would move it. The same
/// error is the catalogue's angular_kink, as a straight line beyond a knee.
///
/// Notation
///   R, r   belt line's radius on the pulley and on the drive gear
///   a      distance of their axes
///   C, Q   the slice's corner, at the critical angle and `beyond` farther
///   S      the drive gear's axis
///   D      the belt's tangent point on the gear
///   l0     straight belt at the critical angle, sqrt(a^2 - (R - r)^2)
///   l      straight belt now, sqrt(|SQ|^2 - r^2)
///   psi    turn of the belt's direction since, which winds r psi more on the gear
///
/// Belt travel beyond the critical angle, against R * beyond on a round pulley:
///
///   l - l0 + r psi                                                                          (1)
///
/// Source: FirePick Delta wiki, "Sliced Pulley Error" (27 September 2015), which keeps the tangent
/// at D fixed; (1) lets it turn. Stateless, thread safe.
///
/// \code
///   const SlicedPulley pulley = firepick_delta_pulley();
///   pulley.critical_angle_rad();                    // -0.9126, that is -52.29 degrees
///   pulley.travel_error_mm(-67.2 * kDegree);        // belt travel less the round pulley's
/// \endcode
#pragma once

namespace chaintrue::model {

/// A straight line beyond a knee: slope * max(0, angle - knee).
struct LinearKink {
  double slope_mm_per_rad = 0.0;
  double knee_rad = 0.0;
  [[nodiscard]] double operator()(double angle_rad) const {
    return angle_rad > knee_rad ? slope_mm_per_rad * (angle_rad - knee_rad) : 0.0;
  }
};

class SlicedPulley {
 public:
  struct Dimensions {
    double pulley_radius_mm = 0.0;  ///< R, of the belt's pitch line
    double gear_radius_mm = 0.0;    ///< r, of the belt's pitch line
    double centre_distance_mm = 0.0;
    double arm_to_corner_rad =
        0.0;  ///< arm's angle when the corner's radius lies on the line of centres' normal
  };

  /// \throws std::invalid_argument where a dimension is not finite or the gear does not fit outside
  /// the pulley.
  explicit SlicedPulley(const Dimensions& dimensions);

  /// Arm angle (negative: raised) at which the belt reaches the corner.
  [[nodiscard]] double critical_angle_rad() const;
  /// Belt wound from the critical angle on, by the corner (1); zero before it.
  [[nodiscard]] double belt_travel_mm(double arm_angle_rad) const;
  /// Belt travel less the round pulley's: never positive, zero up to the critical angle.
  [[nodiscard]] double travel_error_mm(double arm_angle_rad) const;
  /// A round pulley's travel per radian, R.
  [[nodiscard]] double travel_per_rad_mm() const { return d_.pulley_radius_mm; }
  /// Least squares line through the error at equally spaced angles, as a kink in the raising angle
  /// (-arm angle). \throws std::invalid_argument for fewer than two samples or from == to.
  [[nodiscard]] LinearKink fit_line(double from_arm_rad, double to_arm_rad, int samples) const;

 private:
  Dimensions d_;
};

/// Share of the commanded travel that is lost beyond the knee: the kink's slope over the round's
/// travel per radian.
[[nodiscard]] double travel_error_ratio(const LinearKink& kink, double travel_per_rad_mm);

/// The published dimensions: GT2 belt (pitch line 0.254 mm above its tooth root, teeth 0.75 mm
/// high), 16-tooth gear, pulley 47.5 mm to its bearing surface, axes 92.114 mm apart, corner at arm
/// angle -24.17 degrees. Only with the belt's own height added to the 47.5 mm do they give the
/// published critical angle of -52.3 degrees.
[[nodiscard]] SlicedPulley firepick_delta_pulley();

}  // namespace chaintrue::model
