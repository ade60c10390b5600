// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The part of a chaintrue_anchors file for holes that were fitted together with the belts. Private
/// to grid/files.
#pragma once

#include "grid/belts/belts_and_holes.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] const Record<HolesWithBelts>& holes_with_belts_record();

}  // namespace chaintrue::grid::files
