// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a number may be that stands in files and on the command line alike. Both ends are allowed.
#pragma once

#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

/// One sigma of a chain length, or of a place on each axis.
inline constexpr Range kNoiseMm{"mm", 0.0, 100.0};
/// How well a noise is known, in degrees of freedom.
inline constexpr Range kNoiseDof{"", 1.0, 1e9};
/// One sigma of a tape's reading.
inline constexpr Range kTapeSigmaMm{"mm", 0.001, 100.0};
/// By how much every reading of a tape is longer than the distance.
inline constexpr Range kHookOffsetMm{"mm", -1000.0, 1000.0};
/// One sigma of that, and of a hole beside where its chains put it.
inline constexpr Range kHoleSigmaMm{"mm", 0.0, 100.0};
/// Over how far a map fades out beyond its points.
inline constexpr Range kFadeWidthMm{"mm", 1.0, 1e5};
/// From square to square of an optical calibration.
inline constexpr Range kOpticalPitchMm{"mm", 5.0, 1000.0};

}  // namespace chaintrue::grid::files
