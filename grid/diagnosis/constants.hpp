// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The numbers that a verdict depends on; constants.def gives their meanings and sources.
/// Probabilities and shares are plain numbers, strengths are in units of noise.
#pragma once

#include <array>
#include <cstddef>

namespace chaintrue::grid::diagnosis {

#define CHAINTRUE_CONSTANT(name, value, meaning, source) inline constexpr double name = value;
#define CHAINTRUE_COUNT(name, value, meaning, source) inline constexpr std::size_t name = value;
#include "grid/diagnosis/constants.def"
#undef CHAINTRUE_CONSTANT
#undef CHAINTRUE_COUNT

/// Multiples of the stated noise, equally likely: hurried or careless measuring.
inline constexpr std::array kLargerNoise = {1.5, 2.0, 2.7};
/// Strengths at which a discrepancy is tried: a quarter of a decade apart where it is hard to see.
inline constexpr std::array kDiscrepancyStrengths = {4.0, 6.5, 10.0, 16.0, 25.0, 60.0};

/// Below this residual share after projection on the settings, a signature is invisible.
inline constexpr double kAbsorbed = 1e-3;

}  // namespace chaintrue::grid::diagnosis
