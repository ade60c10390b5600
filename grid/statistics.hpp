// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Medians, root mean squares, sums of exponentials, normal tails and the noise of rounding.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// The middle value; for an even number the mean of the two middle ones. \throws
/// std::invalid_argument for no values.
double median(std::vector<double> values);

/// sqrt(mean(v^2)); 0 for no values.
double rms(const std::vector<double>& values);
/// Over all components; 0 for no values.
double rms(const std::vector<Vector2d>& values);

/// For the vectors' lengths; 0 for no values.
double rms_length(const std::vector<Vector2d>& values);

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// log(0).
inline constexpr double kMinusInfinity = -kInfinity;

/// log(exp(a) + exp(b)), without overflow; minus infinity is log(0).
double log_sum(double a, double b);
/// log(sum exp(t)); minus infinity for no terms.
double log_sum(const std::vector<double>& terms);

/// Probability that a standard normal variable exceeds z.
inline double normal_upper(double z) { return 0.5 * std::erfc(z / std::numbers::sqrt2); }

/// log of the probability beyond z; asymptotic where erfc underflows.
inline double log_normal_upper(double z) {
  if (z < 25.0) return std::log(normal_upper(z));
  return -0.5 * z * z - std::log(z * std::sqrt(2.0 * std::numbers::pi)) - 1.0 / (z * z);
}

/// log of the probability between low < high, in sigmas about the mean.
inline double log_normal_mass(double low, double high) {
  // Beyond, both tails are below half a unit in the last place of 1.
  constexpr double kNoTail = 8.3;
  if (low < -kNoTail && high > kNoTail) return 0.0;
  if (high < 0.0) return log_normal_mass(-high, -low);
  if (low <= 0.0) {
    const double outside = normal_upper(-low) + normal_upper(high);
    // The series' next term is below 1e-18. Most bounds are far away, and log1p would dominate the
    // time.
    return outside < 1e-6 ? -outside - 0.5 * outside * outside : std::log1p(-outside);
  }
  const double a = log_normal_upper(low);
  const double b = log_normal_upper(high);
  return b >= a ? kMinusInfinity : a + std::log1p(-std::exp(b - a));
}

/// Standard deviation of the rounding error of these readings, step / sqrt(12). The step is the
/// largest that divides all of them: 1, 0.5 or 0.2 mm, 1/16, 1/32 or 1/64 inch, or a power of ten
/// below of these millimetres. 0 for readings with all their digits, for fewer than four, and if
/// all are multiples of 5 mm or of a quarter of an inch, which are chosen places.
double rounding_sigma_mm(const std::vector<double>& readings_mm);

}  // namespace chaintrue::grid
