// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A visiting order for points that bear none, as somebody remembers it.
#pragma once

#include <optional>
#include <string>

#include "grid/observation/visiting_order.hpp"

namespace chaintrue::cli {

/// The word of --assume-order (rows, columns, serpentine_rows, serpentine_columns), lines from the top left;
/// empty where it is none of them.
[[nodiscard]] std::optional<grid::VisitingOrder> order_from_word(const std::string& word);

}  // namespace chaintrue::cli
