// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_answer files: the truth of a simulated grid. Written to a separate file, or not at
/// all.
///
///   { "file_type": "chaintrue_answer", "format_version": "1.0", "seed": 1,
///     "effects": [ as in a machine file ],                       // the hidden ones
///     "settings": [ {"setting": "motor_left_x_mm", "offset": 1.7} ],   // truth less stated
///     "sheet": {"x_mm": 0, "y_mm": 0, "rotation_rad": 0},
///     "bad_points": [indices into points],
///     "points": [ {"x_mm", "y_mm", "left_mm", "right_mm"} ],  // true places, no noise in readings
///     "machine": { the true machine } }
#pragma once

#include <string>
#include <vector>

#include "grid/synthetic/effect_picture.hpp"
#include "grid/synthetic/generator.hpp"
#include "grid/synthetic/holes.hpp"

namespace chaintrue::grid::files {

std::string write_answer(const synthetic::SyntheticAnswer& answer);
/// For holes: `points` are the holes' true positions on the sheet and the lengths that the
/// controller paid out for them; "bad_distances", indices into the distances, replaces
/// "bad_points".
std::string write_answer(const synthetic::SyntheticHoles& made, const synthetic::HolesSpec& spec);

// The catalogue of effects, and the picture of one effect, as JSON for programs.

/// { "file_type": "chaintrue_effects", ..., "effects": [ {"effect", "station", "sides",
/// "parameters", words ...} ] }
std::string write_catalogue(const std::vector<const Effect*>& effects);
/// { "file_type": "chaintrue_effect_picture", ..., "effect", "marks", "squares", "strength" }
std::string write_effect_picture(const synthetic::EffectPicture& picture);

}  // namespace chaintrue::grid::files
