// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a fit of belts says of the holes beside them, as it stands in a chaintrue_anchors file.
/// Private to grid/files.
#pragma once

#include "grid/belts/belts_and_holes.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] const Record<HolesBesideBelts>& holes_beside_belts_record();

}  // namespace chaintrue::grid::files
