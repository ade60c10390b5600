// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A plan as a page to print: the bed drawn, the steps in order, and lines to write the readings
/// on. For both A4 and Letter; nothing is fetched, no script runs. Same plan, same bytes.
#pragma once

#include <string>

#include "grid/planning/holes_plan.hpp"
#include "tools/cli/sheet.hpp"

namespace chaintrue::cli {

/// `list` is the file for the readings; empty: standard output.
[[nodiscard]] std::string sheet_page(const Sheet& sheet,
                                     const Machine& machine,
                                     const std::string& list);
[[nodiscard]] std::string holes_page(const grid::HolesPlan& plan, const std::string& list);

}  // namespace chaintrue::cli
