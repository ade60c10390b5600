// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Medians, root mean squares and sums of exponentials.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

namespace chaintrue::grid {

/// The middle value, of an even number the mean of the two middle ones. \throws
/// std::invalid_argument for no values.
[[nodiscard]] double median(std::vector<double> values);

/// sqrt(mean(v^2)); 0 for no values.
[[nodiscard]] double rms(const std::vector<double>& values);
/// Over all components; 0 for no values.
[[nodiscard]] double rms(const std::vector<Eigen::Vector2d>& values);

/// Of the vectors' lengths; 0 for no values.
[[nodiscard]] double rms_length(const std::vector<Eigen::Vector2d>& values);

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// log(0).
inline constexpr double kMinusInfinity = -kInfinity;

/// log(exp(a) + exp(b)), without overflow; minus infinity is log(0).
[[nodiscard]] double log_sum(double a, double b);
/// log(sum exp(t)); minus infinity for no terms.
[[nodiscard]] double log_sum(const std::vector<double>& terms);

}  // namespace chaintrue::grid
