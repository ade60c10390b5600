// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Ranges of numbers that occur both in files and on the command line. Both ends are allowed.
#pragma once

#include "grid/files/number_text.hpp"

namespace chaintrue::grid::files {

/// A coordinate of any hanging router or plotter: wide enough for each, narrow enough to catch a misplaced
/// decimal point or another unit.
inline constexpr Range kCoordinateMm{"mm", -20000.0, 20000.0};
/// Length of a chain or a belt.
inline constexpr Range kLengthMm{"mm", 1.0, 20000.0};
/// One sigma of a chain length, or of a position on each axis.
inline constexpr Range kNoiseMm{"mm", 0.0, 100.0};
/// Degrees of freedom of a noise estimate.
inline constexpr Range kNoiseDof{"", 1.0, 1e9};
/// One sigma of a tape reading.
inline constexpr Range kTapeSigmaMm{"mm", 0.001, 100.0};
/// Tape zero offset: reading less distance.
inline constexpr Range kTapeZeroOffsetMm{"mm", -1000.0, 1000.0};
/// One sigma of that, and of a hole about the position that its chains give.
inline constexpr Range kHoleSigmaMm{"mm", 0.0, 100.0};
/// Width over which a map fades out beyond its points.
inline constexpr Range kFadeWidthMm{"mm", 1.0, 1e5};
/// Spacing of the squares of an optical calibration.
inline constexpr Range kOpticalPitchMm{"mm", 5.0, 1000.0};

}  // namespace chaintrue::grid::files
