// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The numbers that a verdict depends on, in one place: constants.def says what each means and where
/// it comes from. Probabilities and shares are plain numbers, strengths are in units of noise.
#pragma once

#include <array>
#include <cstddef>

namespace chaintrue::grid::diagnosis {

#define CHAINTRUE_CONSTANT(name, value, meaning, source) inline constexpr double name = value;
#define CHAINTRUE_COUNT(name, value, meaning, source) inline constexpr std::size_t name = value;
#include "grid/diagnosis/constants.def"
#undef CHAINTRUE_CONSTANT
#undef CHAINTRUE_COUNT

/// Besides the stated noise, one of these multiples of it, equally likely: what hurried or careless
/// measuring makes of a tape.
inline constexpr std::array kLargerNoise = {1.5, 2.0, 2.7};
/// Strengths at which a discrepancy is tried: a quarter of a decade apart where it is hard to see.
inline constexpr std::array kDiscrepancyStrengths = {4.0, 6.5, 10.0, 16.0, 25.0, 60.0};

/// Where the settings leave less than this share of a signature there is nothing to see.
inline constexpr double kAbsorbed = 1e-3;

}  // namespace chaintrue::grid::diagnosis
