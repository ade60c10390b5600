// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The surfaces of a map in a chaintrue_map file. Private to grid/files.
#pragma once

#include "grid/files/json_reader.hpp"
#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] Record<interp::Rectangle> rectangle_record();

/// The keys on_machine and direct, of which a map has one.
void add_surface(Record<MapContents>& record);

}  // namespace chaintrue::grid::files
