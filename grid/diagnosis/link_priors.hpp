// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How probable beforehand it is that links were lost at one visit rather than at another.
#pragma once

#include "grid/diagnosis/evidence.hpp"

namespace chaintrue::grid::diagnosis {

/// Shares a cause's prior out among its visits and numbers of links, and gives slips at one visit
/// their odds. A whole number leaves no size free whose prior could say how strong causes usually
/// are, so the visits carry it: density of the strength at each, as for any other cause.
/// `marginalised` sets no point aside.
void share_out_links(const MarginalisedSystem& marginalised, RegressorSystem& system);

}  // namespace chaintrue::grid::diagnosis
