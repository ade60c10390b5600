// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A self-explanatory drawing of a cut square: the commanded outline, the cut one with its errors
/// magnified, and the numbers that a ruler would show. Same square, same bytes.
#pragma once

#include <string>

#include "model/square.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// A self-contained SVG; nothing is fetched, no script runs.
[[nodiscard]] std::string draw_square(const model::CutSquare& square, const SquareTask& task);

}  // namespace chaintrue::cli
