// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What may have changed in two chains since their machine was calibrated (mechanism_change.hpp).
#pragma once

#include <vector>

#include "model/mechanism_change.hpp"

namespace chaintrue::model {

/// One sigma of a zero shift: re-hanging a chain shifts it by up to 3 mm.
inline constexpr double kZeroShiftSigmaMm = 2.0;
/// One sigma of pitch growth: 0.05 % is a year's wear.
inline constexpr double kPitchGrowthSigma = 5e-4;

/// Possible changes of two chains if only their links are known: zeros, skipped teeth, worn links.
std::vector<MechanismChange> changes_of_chains(double pitch_mm);

}  // namespace chaintrue::model
