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
///   const ReadGrid read = read_grid("grid.csv", {.machine = read_machine("machine.json")});
///   for (const Warning& warning : read.warnings) fmt::print(stderr, "{}\n", warning.message());
///   fit(read.grid);
/// \endcode
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/observation/measured_grid.hpp"

namespace chaintrue::grid::files {

/// Values that a CSV does not contain, or that override the file's own.
struct GridOptions {
  std::optional<model::Machine> machine;  ///< --machine
  std::optional<StatedNoise> noise;       ///< --noise-length-mm, --noise-position-mm, --noise-dof
  /// From this number on, the points must also span an area. A few points that only check a map
  /// pass 1.
  std::size_t fewest_points = 8;
  /// Used for a file that names no machine: the machine of the map to be checked.
  std::optional<model::Machine> otherwise = std::nullopt;
  /// What was measured is in inches, in a CSV whose header says mm: marks and lengths, but not the
  /// commands. JSON is as its keys say.
  bool inches = false;
};

struct ReadGrid {
  MeasuredGrid grid;
  /// Problems that are not fatal: repeats that disagree, values that were assumed.
  std::vector<Warning> warnings;
};

/// "-" reads standard input. A file that begins with "{" is JSON, any other CSV with a header line.
/// Messages name recognised mistakes (left and right columns swapped, inches for mm, decimal
/// commas). The path of a "machine_file" is relative to the grid's folder. \throws InputError with
/// every problem of the file.
[[nodiscard]] ReadGrid read_grid(const std::filesystem::path& path,
                                 const GridOptions& options = {});
/// `file` is the name used in messages; a "machine_file" is looked for in its folder.
[[nodiscard]] ReadGrid parse_grid(const std::string& text,
                                  const std::string& file,
                                  const GridOptions& options = {});
/// JSON. \throws std::logic_error where a number is not finite.
[[nodiscard]] std::string write_grid(const MeasuredGrid& grid);
/// A sheet to fill in, in the same format: null for both coordinates of a point that has a command,
/// for both lengths of any other.
[[nodiscard]] std::string write_grid_sheet(const MeasuredGrid& plan);

}  // namespace chaintrue::grid::files
