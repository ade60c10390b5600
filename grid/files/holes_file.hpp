// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_holes files, JSON or CSV. Unknown keys are errors, except "comment". Same holes, same
/// bytes.
///
///     { "file_type": "chaintrue_holes", "format_version": "1.0", "name": "...",
///       "machine": { a chaintrue_machine, or the machine of a chaintrue_belts file with the anchors
///                    in force when the holes were cut } or "machine_file": "path",
///       "tape": {"sigma_mm": 0.5, "hook_offset_mm": 40},
///       "hole_sigma_mm": 0.3, "noise_dof": 15,
///       "sheet": {"width_mm": 2440, "height_mm": 1220, "size_sigma_mm": 1},
///       "readings": [ {"what": "link_pitch_mm", "side": "left", "value": 6.353, "sigma": 0.001} ],
///       "holes": [ {"name": "A", "x_mm": -900, "y_mm": 400}, ... ],
///       "distances": [ {"from": "A", "to": "B", "distance_mm": 1840.5, "sigma_mm": 0.5},
///                      {"from": "A", "to": "top", "distance_mm": 249} ] }
///
/// `from` and `to` name holes, or count them from 0; `to` may be an edge of the sheet: left, right,
/// top, bottom. A hole without a name is named by its number. The machine includes the controller
/// that cut the holes, with its settings.
///
/// `readings` are those of a chaintrue_grid, and optional.
///
/// A CSV has two tables: lines below `hole,x_mm,y_mm`, and lines below
/// `from,to,distance_mm,sigma_mm` (the last column may be missing; a plan's `as_commanded_mm` is
/// ignored). The rest is given as options. A distance that is left blank (in JSON null) is left out,
/// with a warning.
///
/// \code
///   const ReadHoles found = read(parse_holes, "holes.json");
///   for (const Warning& warning : found.warnings) fmt::print(stderr, "{}\n", warning.message());
///   const auto fit = joint_fit(found.holes);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/files/measured_options.hpp"
#include "grid/observation/measured_holes.hpp"
#include "model/belts/belt_machine.hpp"

namespace chaintrue::grid::files {

struct ReadHoles {
  MeasuredHoles holes;
  /// For a file whose machine hangs on four belts; the holes then have no machine of chains.
  std::optional<BeltMachine> belt_machine = std::nullopt;
  std::vector<Warning> warnings;
};

/// Messages name recognised mistakes (inches, a triangle that cannot close, a tape zero offset that
/// was forgotten). `file` is the name used in messages; a "machine_file" is looked for in its folder.
/// \throws InputError with every problem.
ReadHoles parse_holes(const std::string& text, const std::string& file,
                      const MeasuredOptions& options = {});
/// JSON. \throws std::logic_error where a number is not finite.
std::string write_holes(const MeasuredHoles& holes,
                        const std::optional<BeltMachine>& belts = std::nullopt);
/// A sheet to fill in, in the same format: null for every distance.
std::string write_holes_sheet(const MeasuredHoles& plan);

}  // namespace chaintrue::grid::files
