// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_grid files, JSON or CSV. Unknown keys are errors, except "comment". Same grid, same
/// bytes.
///
/// A CSV has a header line with the names of its columns in any order: x_mm, y_mm, left_mm,
/// right_mm, and optionally order, commanded_x_mm, commanded_y_mm. Cells are separated by commas,
/// semicolons or tabs; numbers have a decimal point, or a decimal comma if commas do not separate
/// cells and no number has a point; lines that begin with # are comments; an empty cell is an
/// absent value.
///
/// A point without readings is left out, with a warning: a mark with both lengths empty, a command
/// with x_mm and y_mm empty (in JSON null).
///
/// \code
///   const ReadGrid found = read(parse_grid, "grid.csv", {.machine = machine});
///   for (const Warning& warning : found.warnings) fmt::print(stderr, "{}\n", warning.message());
///   fit(found.grid);
/// \endcode
#pragma once

#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/measured_options.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::files {

struct ReadGrid {
  MeasuredGrid grid;
  /// Problems that are not fatal: repeats that disagree, values that were assumed.
  std::vector<Warning> warnings;
};

/// Text that begins with "{" is JSON, any other CSV with a header line. Messages name recognised
/// mistakes (left and right columns swapped, inches for mm, decimal commas). `file` is the name used
/// in messages; a "machine_file" is looked for in its folder. \throws InputError with every problem
/// of the file.
ReadGrid parse_grid(const std::string& text, const std::string& file,
                    const MeasuredOptions& options = {});
/// JSON. \throws std::logic_error where a number is not finite.
std::string write_grid(const MeasuredGrid& grid);
/// A sheet to fill in, in the same format: null for both coordinates of a point that has a command,
/// for both lengths of any other.
std::string write_grid_sheet(const MeasuredGrid& plan);

}  // namespace chaintrue::grid::files
