// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A visiting order for points that bear none, as somebody remembers it.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/files/optical_file.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::cli {

/// The word of --assume-order (rows, columns, serpentine_rows, serpentine_columns); empty where it
/// is none of them.
[[nodiscard]] std::optional<grid::files::VisitOrder> order_from_word(const std::string& word);

/// Numbers of the visits, point by point: lines of marks from the top left, as VisitOrder has them.
/// Marks stand in one line where no gap across it is wider than a quarter of the usual spacing.
/// Second visits (marks within 25 mm of an earlier one) come last, in the order of the file. A
/// sentence where the marks stand in no lines.
[[nodiscard]] tl::expected<std::vector<int>, std::string> assumed_order(
    const std::vector<grid::MeasuredPoint>& points, grid::files::VisitOrder order);

}  // namespace chaintrue::cli
