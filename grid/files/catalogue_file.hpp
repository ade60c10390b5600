// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue of effects, and the picture of one effect, as JSON for programs.
#pragma once

#include <string>
#include <vector>

#include "grid/synthetic/effect_picture.hpp"

namespace chaintrue::grid::files {

/// { "file_type": "chaintrue_effects", ..., "effects": [ {"effect", "station", "sides",
/// "parameters", words ...} ] }
[[nodiscard]] std::string write_catalogue(
    const std::vector<const model::effects::Effect*>& effects);
/// { "file_type": "chaintrue_effect_picture", ..., "effect", "marks", "squares", "strength" }
[[nodiscard]] std::string write_effect_picture(const synthetic::EffectPicture& picture);

}  // namespace chaintrue::grid::files
