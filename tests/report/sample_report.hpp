// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A document like that of a map of a 7 x 4 grid, from made-up data.
#pragma once

#include "tools/report/map_pictures.hpp"

namespace chaintrue::report::testing {

/// 28 points, one of them bad; a smooth error of some millimetres before, noise after.
MapPictures sample_pictures();
/// The pictures with verdict, advice, settings and texts.
Document sample_document(const MapPictures& map = sample_pictures());

inline constexpr int kSamplePoints = 28;
inline constexpr int kSampleCells = 33 * 17;

}  // namespace chaintrue::report::testing
