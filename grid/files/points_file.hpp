// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Bare points of the bed: a CSV whose header names x_mm and y_mm, and order where the visits are
/// numbered.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid::files {

struct ListedPoint {
  model::BedPoint place;
  /// All points have it, distinct, or none.
  std::optional<int> order;
};

/// "-" reads standard input. \throws InputError with every problem of the file.
[[nodiscard]] std::vector<ListedPoint> read_points(const std::filesystem::path& path);
[[nodiscard]] std::vector<ListedPoint> parse_points(const std::string& text,
                                                    const std::string& file);

}  // namespace chaintrue::grid::files
