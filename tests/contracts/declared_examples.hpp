// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Declared effects for the contracts: the examples of docs/effects.md, and one that uses every
/// variable of a chain.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grid/files/effect_file.hpp"
#include "grid/files/whole_file.hpp"
#include "model/effects/declared_effect.hpp"

namespace chaintrue::model::effects {

inline const Effect& declared_by(const std::string& file) {
  const std::string path = std::string(CHAINTRUE_FIXTURES) + "/effects/" + file;
  return declared_effect(grid::files::parse_effect(grid::files::read_whole_file(path), file));
}

/// Every variable of a chain; the same for the mirror image.
inline const Effect& uses_everything() {
  return declared_effect(grid::files::parse_effect(R"JSON({
    "file_type": "chaintrue_effect", "format_version": "1.0", "id": "uses_everything",
    "acts_on": "chain", "sides": ["left", "right", "both"],
    "parameters": [{"name": "size_mm", "prior_sigma": 0.3, "lower": -3, "upper": 3}],
    "adds_mm": "size_mm * (cos(x / (400 * mm)) * exp(y / (900 * mm)) + r / (1000 * mm) + H / (T + 10 * N) + log(S / turn) - phi^2 * (L0 / S - 1) + pitch / turn)",
    "cause": "none", "remedy": "none", "not_modelled": "nothing"})JSON",
                                                   "everything.json"));
}

inline const std::vector<const Effect*>& declared_examples() {
  static const std::vector<const Effect*> examples = {
      &declared_by("chain_rubs.json"), &declared_by("creep_that_saturates.json"),
      &declared_by("second_harmonic.json"), &uses_everything()};
  return examples;
}

/// The effects of the catalogue that can be declared in files, as such declarations.
inline std::vector<const Effect*> catalogue_in_files() {
  std::vector<const Effect*> all;
  const auto folder = std::filesystem::path(CHAINTRUE_FIXTURES) / "effects" / "catalogue";
  for (const auto& file : std::filesystem::directory_iterator(folder))
    all.push_back(&declared_by("catalogue/" + file.path().filename().string()));
  return all;
}

}  // namespace chaintrue::model::effects
