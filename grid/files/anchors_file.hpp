// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_anchors files: the result of a fit of four belts. Unknown keys are errors, except
/// "comment". Same fit, same bytes.
///
///     { "file_type": "chaintrue_anchors", "format_version": "1.0", "name": "...",
///       "fit": {
///       "machine": { as in a chaintrue_belts file, with the anchors fitted },
///       "coordinates": [ {"coordinate": "tl_x_mm", "stated_mm": -27.6, "fitted_mm": -31.2,
///                         "sigma_mm": 0.4, "rests_on": {"tl": 0.5, "tr": 0.1, "bl": 0.3, "br": 0.1}} ],
///       "covariance_mm2": [[...], ...],
///       "spread_mm": 0.52, "checks": 157, "rms_mm": 0.36, "rms_of_mm": {"tl": 0.3, ...},
///       "predicted": { "one_left_out": {"readings": 162, "rms_mm": 0.8, "largest_mm": 2.1},
///                     "half_left_out": {...} },
///       "causes": [ {"effect": "belt_stretch", "parameters": {"elongation": 0.0041},
///                    "sigma": 0.0003, "probability": 1} ],
///       "scale": {"factor": 0.9991, "sigma": 0.0003, "residuals_mm": [0.2]},
///       "bad": [ {"point": 17, "belt": "tl", "off_mm": 80.2} ], "bad_points": [],
///       "places": [ {"x_mm": .., "y_mm": .., "covariance_mm2": [xx, xy, yy],
///                    "tl": {"off_mm": .., "counts": true, "sigmas": .., "beside_mm": ..}, ...} ] },
///       "holes": { the fit's residuals and positions of holes that were cut and taped } }
///
/// `scale` is absent if it is not known. Lengths are in the belts' own millimetres.
///
/// \code
///   const FittedAnchors found = parse_anchors(read_whole_file("anchors.json"), "anchors.json");
///   fmt::print("{}", write_maslow4_settings(found.fit).text);
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_and_holes.hpp"
#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/input_error.hpp"
#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

struct FittedAnchors {
  std::string name;
  BeltsFit fit;
  std::optional<HolesWithBelts> holes = std::nullopt;  ///< if holes were fitted as well
};

/// `file` is the name used in messages. \throws InputError with every problem.
FittedAnchors parse_anchors(const std::string& text, const std::string& file);
/// \throws std::logic_error where a number is not finite.
std::string write_anchors(const FittedAnchors& anchors,
                          const std::optional<Provenance>& made_by = std::nullopt);

/// Lines to paste into the machine's terminal, with remarks for the user.
struct Maslow4Settings {
  std::string text;
  std::vector<std::string> remarks;
};
Maslow4Settings write_maslow4_settings(const BeltsFit& fit);
/// From a diagnosis of belts: the anchors, with those of its causes that are settings of the machine
/// applied. \throws std::invalid_argument for a diagnosis of chains.
Maslow4Settings write_maslow4_settings(const diagnosis::Diagnosis& found);
/// The machine's settings once the lines are pasted.
BeltMachine machine_as_pasted(const BeltsFit& fit);

}  // namespace chaintrue::grid::files
