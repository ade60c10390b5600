// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A regressor's power and bounds from secants: how its signature grows with its size
/// (regressor_system.hpp), and which coefficients its parameter's range leaves.
#pragma once

#include <Eigen/Core>

#include "grid/diagnosis/regressor_system.hpp"

namespace chaintrue::grid::diagnosis {

/// Of a size: far enough for differences, near enough for a slope.
inline constexpr double kNearby = 0.95;

/// The coefficient's power: how the signature grows from half the size to the whole one.
[[nodiscard]] double power_of(const Eigen::VectorXd& whole, const Eigen::VectorXd& half);

/// The same about a size that was found, `nearby` at kNearby of it. A signature that hardly grows any
/// more leaves its size open; one that shrinks again has no power.
[[nodiscard]] double power_about(const Eigen::VectorXd& whole, const Eigen::VectorXd& nearby);

/// Sets what the coefficient may be from the range of the size.
void limit(Regressor& regressor);

}  // namespace chaintrue::grid::diagnosis
