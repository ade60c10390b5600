// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether a calibrated mechanism still holds, from lengths that it has read since at places that are
/// known or not.
///
/// Residuals and their derivatives are those of the observation (belt_lengths.hpp), linearised about
/// the mechanism as calibrated; what that does not know of itself is its parameters' covariance. What
/// may have changed the mechanism says (mechanism_change.hpp).
///
/// \code
///   const auto check = check_lengths({mechanism, covariance, 0.4, 23.0}, places);
///   if (check) say(check->sentence);
/// \endcode
#pragma once

#include <Eigen/Core>
#include <memory>
#include <tl/expected.hpp>
#include <vector>

#include "grid/map/check_words.hpp"
#include "grid/observation/belt_lengths.hpp"
#include "grid/statistics.hpp"

namespace chaintrue::grid {

/// A mechanism with the values that were found, and how well.
struct FittedMechanism {
  std::shared_ptr<const model::Mechanism> mechanism;
  Eigen::MatrixXd covariance;  ///< of its parameters
  double length_mm = 0.0;      ///< one sigma of a length that is read
  /// Of the fit that found the noise; infinite: it is known.
  double noise_dof = kInfinity;
  double position_mm = 0.0;  ///< one sigma of a known position, on each axis
};

/// Places of which so few lengths count that they check nothing are left out.
/// \throws std::invalid_argument for a noise that is not positive.
[[nodiscard]] tl::expected<Check, CheckFailure> check_lengths(
    const FittedMechanism& fitted,
    const std::vector<observation::LengthsAtPlace>& places,
    const CheckWords& words);
/// In words of the mechanism's own names.
[[nodiscard]] tl::expected<Check, CheckFailure> check_lengths(
    const FittedMechanism& fitted, const std::vector<observation::LengthsAtPlace>& places);

}  // namespace chaintrue::grid
