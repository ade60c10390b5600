// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_grid files, JSON or CSV. Unknown keys are errors, except "comment". Same grid, same bytes.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "grid/measured_grid.hpp"

namespace chaintrue::grid::files {

/// What a CSV cannot say, or what the command line puts in place of the file's own.
struct GridOptions {
  std::optional<model::Machine> machine;  ///< --machine
  std::optional<StatedNoise> noise;       ///< --noise-length-mm, --noise-position-mm, --noise-dof
};

/// "-" reads standard input. A file that begins with "{" is JSON, anything else CSV with a header line. Slips that can
/// be recognised (columns swapped left for right, inches for mm, decimal commas) are said in words.
/// \throws InputError with every problem of the file.
[[nodiscard]] MeasuredGrid read_grid(const std::filesystem::path& path, const GridOptions& options = {});
[[nodiscard]] MeasuredGrid parse_grid(const std::string& text, const std::string& file, const GridOptions& options = {});
[[nodiscard]] std::string write_grid(const MeasuredGrid& grid);

}  // namespace chaintrue::grid::files
