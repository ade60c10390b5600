// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Points of the bed from a CSV with the columns x_mm and y_mm; from a list of commands, such as a
/// plan's, the commands. The CSV format is that of grid_file.hpp.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid::files {

/// In the file's order. "-" reads standard input. \throws InputError with every problem of the
/// file.
std::vector<MarkPoint> read_points(const std::filesystem::path& path);
/// `file` is the name used in messages.
std::vector<MarkPoint> parse_points(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
