// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The size of the noise from points that were measured more than once, and the floor that rounding
/// (grid/statistics.hpp) sets to it: second visits that agree exactly show only that the scatter is
/// below the resolution of the rule.
#pragma once

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "grid/containers.hpp"
#include "grid/map/fitted_points.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// Of the marks of points that give a command, and for the lengths of those that give lengths.
observation::PointNoise rounding_noise(const MeasuredGrid& grid);
/// The stated noise, but not below this floor.
StatedNoise not_below_rounding(StatedNoise stated, const MeasuredGrid& grid);

struct RepeatNoise {
  double factor = 1.0;  ///< the noise, as a multiple of the one that the fit assumed
  double dof = 0.0;     ///< its degrees of freedom
};

/// From the scatter of a fit's residuals within each group of repeats, not below what rounding
/// leaves; outliers do not count. Empty with fewer than four degrees of freedom (two repeats),
/// which is too few, and if repeats with all digits agree exactly.
std::optional<RepeatNoise> noise_from_repeats(const std::vector<FittedPoint>& points,
                                              const observation::PointNoise& noise,
                                              const observation::PointNoise& rounding);

/// The scatter of whitened residuals within groups of repeats, gathered point by point.
class RepeatScatter {
 public:
  /// \param noise the noise by which the residuals are whitened
  RepeatScatter(const observation::PointNoise& noise, const observation::PointNoise& rounding)
      : noise_(noise), rounding_(rounding) {}
  /// \param by_mark derivatives of the lengths by the mark
  void add(const Vector2d& residual_mm, const Matrix2d& by_mark);

  void end_group();

  std::optional<RepeatNoise> noise() const {
    constexpr double kFewestDof = 4.0;
    // For the noise that residuals are whitened by: repeats that agree so well are copies.
    constexpr double kNothing = 1e-6;
    if (dof_ < kFewestDof) return std::nullopt;
    const double factor = std::sqrt(std::max(squares_ / dof_, rounding_squares_ / rows_));
    return factor > kNothing ? std::optional(RepeatNoise{factor, dof_}) : std::nullopt;
  }

 private:
  observation::PointNoise noise_;
  observation::PointNoise rounding_;
  std::vector<Vector2d> group_;
  double squares_ = 0.0;
  double dof_ = 0.0;
  double rounding_squares_ = 0.0;
  double rows_ = 0.0;
};

}  // namespace chaintrue::grid
