// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The tables of the formats as JSON Schemas, each made by the file that reads the format. Private
/// to grid/files; format_pages.hpp is the public interface.
#pragma once

#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {

[[nodiscard]] Json machine_schema();
[[nodiscard]] Json grid_schema();
[[nodiscard]] Json holes_schema();
[[nodiscard]] Json map_schema();
[[nodiscard]] Json diagnosis_schema();
[[nodiscard]] Json sweep_schema();
[[nodiscard]] Json belts_schema();
[[nodiscard]] Json anchors_schema();
[[nodiscard]] Json effect_schema();
[[nodiscard]] Json plotter_schema();
[[nodiscard]] Json drawing_schema();

}  // namespace chaintrue::grid::files
