// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A remembered visiting order for points without one.
#pragma once

#include <optional>
#include <string>

#include "grid/observation/visiting_order.hpp"

namespace chaintrue::cli {

/// The word of --assume-order (rows, columns, serpentine_rows, serpentine_columns), lines from the top left;
/// empty for any other word.
[[nodiscard]] std::optional<grid::VisitingOrder> order_from_word(const std::string& word);

}  // namespace chaintrue::cli
