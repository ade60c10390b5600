// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Checks whether a calibrated mechanism is still valid, from lengths read since at known or
/// unknown places.
///
/// Residuals and their derivatives are those of the observation (belt_lengths.hpp), linearised
/// about the calibrated mechanism, whose uncertainty is its parameters' covariance. The mechanism
/// lists the possible changes (mechanism_change.hpp).
///
/// \code
///   const auto check = check_lengths({mechanism, covariance, 0.4, 23.0}, places);
///   if (check) say(check->sentence);
/// \endcode
#pragma once

#include <memory>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/check_evidence.hpp"
#include "grid/observation/belt_lengths.hpp"
#include "grid/statistics.hpp"
#include "interp/eigen.hpp"

namespace chaintrue::grid {

/// A mechanism with its calibrated values and their covariance.
struct FittedMechanism {
  std::shared_ptr<const Mechanism> mechanism;
  MatrixXd covariance;     ///< of its parameters
  double length_mm = 0.0;  ///< one sigma of a length that is read
  /// For the fit that found the noise; infinite: it is known.
  double noise_dof = kInfinity;
  double position_mm = 0.0;  ///< one sigma of a known position, on each axis
};

/// Places with too few lengths for a check are left out.
/// \throws std::invalid_argument for a noise that is not positive.
[[nodiscard]] tl::expected<Check, CheckFailure> check_lengths(
    const FittedMechanism& fitted, const std::vector<observation::LengthsAtPlace>& places,
    const CheckWords& words);
}  // namespace chaintrue::grid
