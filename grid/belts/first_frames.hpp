// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Starting points for a fit of anchors. Private to grid/belts and what checks anchors.
#pragma once

#include <vector>

#include "grid/belts/anchor_fit.hpp"

namespace chaintrue::grid::belts {

/// Where the four spans of a point come nearest to one another, from where those of the lower
/// anchors, or of the upper, cross.
[[nodiscard]] model::FramePoint nearest_place(const model::BeltMachine& machine,
                                              const BeltPoint& point,
                                              const model::PerBelt<bool>& counting);

/// Starting anchors, the likeliest first: the known ones, and rectangles of sizes consistent with
/// the lengths.
[[nodiscard]] std::vector<AnchorVector> first_frames(const MeasuredBelts& belts);

}  // namespace chaintrue::grid::belts
