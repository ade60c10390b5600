// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The size of the noise from points that were measured more than once.
#pragma once

#include <optional>
#include <vector>

#include "grid/map/fitted_points.hpp"

namespace chaintrue::grid {

struct RepeatNoise {
  double factor = 1.0;  ///< the noise, as a multiple of the one the fit went in with
  double dof = 0.0;     ///< how well that is known
};

/// From the scatter of a fit's residuals within each group of repeats; outliers do not count.
/// Empty where there are fewer than four degrees of freedom (two repeats): that is too little to go
/// by.
[[nodiscard]] std::optional<RepeatNoise> noise_from_repeats(const PointsFit& fit,
                                                            const observation::PointNoise& noise);

}  // namespace chaintrue::grid
