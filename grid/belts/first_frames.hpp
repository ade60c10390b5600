// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where a fit of anchors begins. Private to grid/belts and what checks anchors.
#pragma once

#include <vector>

#include "grid/belts/anchor_fit.hpp"

namespace chaintrue::grid::belts {

/// Where the four spans of a point come nearest to one another, from where those of the lower
/// anchors, or of the upper, cross.
[[nodiscard]] model::FramePoint nearest_place(const model::BeltMachine& machine,
                                              const BeltPoint& point,
                                              const model::PerBelt<bool>& counting);

/// Anchors to begin at, the likeliest first: those that are known, and rectangles of the size that
/// the lengths leave.
[[nodiscard]] std::vector<AnchorVector> first_frames(const MeasuredBelts& belts);

}  // namespace chaintrue::grid::belts
