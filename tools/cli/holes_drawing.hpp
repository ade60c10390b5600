// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A plan of holes as a drawing: the sheet, the holes by name, a line for each distance to measure.
/// Same plan, same bytes.
#pragma once

#include <string>

#include "grid/planning/holes_plan.hpp"

namespace chaintrue::cli {

/// A self-contained SVG; nothing is fetched, no script runs.
[[nodiscard]] std::string draw_holes_plan(const grid::HolesPlan& plan);

}  // namespace chaintrue::cli
