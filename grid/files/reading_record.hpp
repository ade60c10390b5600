// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// `readings` of the machine itself in a file of points or of holes. Private to grid/files.
#pragma once

#include "grid/files/json_reader.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] Record<ExtraReading> reading_record();
/// "motor_spacing_mm", ...
[[nodiscard]] Value<ReadingOf> reading_name();

}  // namespace chaintrue::grid::files
