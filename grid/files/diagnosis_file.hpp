// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_diagnosis files: the result of a diagnosis, with every number that its report shows.
/// Unknown keys are errors, except "comment". Same diagnosis, same bytes.
///
///   { "file_type": "chaintrue_diagnosis", "format_version": "1.0",
///     "verdict": "named", "sentence": "...", "what_to_do": [...], "not_proved": "...",
///     "causes":     [ {"effect": "chain_pitch_error", "side": "left", "probability": 0.97,
///                      "same_as": [ {"effect", "side", "parameters"} ],
///                      "parameters": {"elongation": {"value": 0.0012, "sigma": 0.0001}}, ...} ],
///     "hypotheses": [ {"effect": "chain_pitch_error", "side": "left", "probability": 0.97} ],
///     "left_over":  {"delta", "follows", "share", "p_value"},
///     "bad_points": [indices], "bad_point_shifts": [ {"x_mm", "y_mm", "sigmas"} ],
///     "not_testable": [...], "bounds": [...], "settings": [...],
///     "gain": {"scheme", "position_rms_mm": {row: mm}, "position_percentile_95_mm": {row: mm},
///              "position_rms_90_percent_mm": {row: [low, high]}, ...},
///     "next_measurements": [...], "extended_machine": { a chaintrue_machine },
///     "stability":  {"probability", "removals": [ {"what": "point", "point": index, "points": 1,
///                    "verdict", "causes", "stands", "probability", "support"} ]}, ... }
///
/// For holes ("observations": "distances"; without the key: points) the file has, instead of
/// points,
///
///     "holes":       [ {"name", "x_mm", "y_mm", "commanded_mm": [x, y]} ],
///     "distances":   [ {"index", "from", "to", "bad", "read_mm", "before_mm", "after_mm", ...} ],
///     "stated_tape": {"tape_sigma_mm", "hole_sigma_mm", "dof"}
///
/// Holes are at the positions where the machine cuts them. bad_points are then indices into the
/// holes file's distances, and bad_point_shifts are {"off_mm", "sigmas"}: the residual from the
/// prediction of all other distances. The errors of "gain" are those of distances.
///
/// A side, the place of a next measurement and "follows" of left_over are null if there is none.
///
/// \code
///   const grid::diagnosis::Diagnosis found = read(parse_diagnosis, "diagnosis.json");
///   fmt::print("{}\n", found.sentence);
/// \endcode
#pragma once

#include <optional>
#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/input_error.hpp"
#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

/// `file` is the name used in messages. \throws InputError with every problem of the file.
diagnosis::Diagnosis parse_diagnosis(const std::string& text, const std::string& file);
/// \throws std::logic_error where a number is not finite.
std::string write_diagnosis(const diagnosis::Diagnosis& diagnosis,
                            const std::optional<Provenance>& made_by = std::nullopt);

}  // namespace chaintrue::grid::files
