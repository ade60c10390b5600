// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_belts files: the lengths that a router on four belts measured. Unknown keys are errors,
/// except "comment". Same belts, same bytes.
///
///     { "file_type": "chaintrue_belts", "format_version": "1.0", "name": "...",
///       "machine": {
///         "name": "Maslow 4",
///         "anchors": { "tl": {"x_mm": -27.6, "y_mm": 2064.9, "z_mm": 100}, "tr": {...},
///                      "bl": {"x_mm": 0, "y_mm": 0, "z_mm": 34}, "br": {...} },
///         "belt": {"turn_mm": 43.975}, "arm_mm": 123.4, "end_extension_mm": 30,
///         "surface_mm": 0, "orientation": "upright", "lengths": "span",
///         "scale_x": 1, "scale_y": 1 },
///       "points": [ {"tl_mm": 998.65, "tr_mm": 2400.6, "bl_mm": 1631.15, "br_mm": 2729.87,
///                    "commanded_x_mm": -600, "commanded_y_mm": 300, "order": 0,
///                    "pulled": ["bl", "br"], "pull_ma": 1300,
///                    "thrown_away": {"tl_mm": [998.1, 1003.4]}} ],
///       "distances": [ {"from": "bl", "to": "br", "distance_mm": 3030, "sigma_mm": 1},
///                      {"from": 3, "to": 17, "distance_mm": 702.5},
///                      {"from": {"x_mm": -900, "y_mm": 300}, "to": {"x_mm": 900, "y_mm": 300},
///                       "distance_mm": 1795} ],
///       "firmware_fit": {"rms_mm": 1.02, "max_mm": 3.4} }
///
/// Only the points are required: fields missing from the machine have the firmware's defaults
/// (model/belts/belt_machine.hpp); x_mm and y_mm of the anchors are unknown if all four are missing.
/// How hard belts were pulled is `pull_ma`, `pull_n` or `pull` (relative): one of them at all points,
/// or at none. `lengths` is the kind of length: belt | belt_and_arm | span. `orientation` is upright | flat. A
/// distance ends at a point of the file (its number, from 0), at an anchor (tl, tr, bl, br) or at a
/// hole that was cut (its commanded position).
///
/// \code
///   const ReadBelts found = read(parse_belts, "belts.json");
///   for (const Warning& warning : found.warnings) fmt::print(stderr, "{}\n", warning.message());
///   const auto fit = fit_belts(found.belts);
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "grid/belts/measured_belts.hpp"
#include "grid/files/input_error.hpp"

namespace chaintrue::grid::files {

/// Requirements on the points as a whole.
enum class BeltsUse {
  fit,     ///< enough points, spread out, consistent with one frame
  import,  ///< a log: few points, or all in one spot, give a warning
};

struct ReadBelts {
  MeasuredBelts belts;
  std::vector<Warning> warnings;
};

/// Messages name recognised mistakes (inches, belts that were swapped, a reading that occurs twice,
/// lengths that fit no position). `file` is the name used in messages. Points of `without`, counted
/// from 1, are left out before all checks except those of the file's form. \throws InputError with
/// every problem.
ReadBelts parse_belts(const std::string& text, const std::string& file,
                      const std::vector<std::size_t>& without = {});
/// The indices of the points that remain without these.
PointIndices indices_without(std::size_t kept, const std::vector<std::size_t>& without);
/// "7,12" of an option, numbers of `what`. \throws InputError where these are not numbers from 1 on.
std::vector<std::size_t> point_numbers_of(
    const std::string& text, const std::string& option,
    std::string_view what = "points as the messages number them");
/// `comments` go under the key "comment", one line each; readers ignore them. \throws
/// std::logic_error where a number is not finite.
std::string write_belts(const MeasuredBelts& belts, const std::vector<std::string>& comments = {});

}  // namespace chaintrue::grid::files
