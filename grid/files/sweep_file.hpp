// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_sweep files: the specification of a sweep.
///
///   { "file_type": "chaintrue_sweep", "format_version": "1.0",
///     "name": "how many points", "question": "How many points do I need?",
///     "seed": 1, "repetitions": 50, "repeats": 6, "draw_settings": true,
///     "evaluation": "40x25",           // raster on which maps are compared with the truth
///     "grids": ["4x3", "7x4"], "spacings": ["regular", "chebyshev"],
///     "noises": [{"length_mm": 0.2, "position_mm": 0.3}], "jitters_mm": [8],
///     "surfaces": ["residual", "direct"],
///     "machines": [{"name": "classic", "machine_file": "../machines/classic.json",
///                   "stated_file": "...", "model": "elastic", "unmodelled_mm": 0.8}],
///     "effects": [{"name": "none", "effects": []}],
///     "used_on": [{"name": "the same machine", "effects": [], "another_of_the_build": false}] }
///
/// Every list but `machines` may be left out; paths are relative to the file.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "grid/files/input_error.hpp"
#include "grid/sweep/sweep_spec.hpp"

namespace chaintrue::grid::files {

struct ReadSweep {
  sweep::SweepSpec spec;
  /// SHA-256 of everything that the results depend on, machines included.
  std::string hash;
  std::vector<Warning> warnings;
};

/// `effects` are chaintrue_effect files; what they declare may act on every machine of the sweep.
/// \throws InputError with every problem of the file, of those it names and of these.
ReadSweep read_sweep(const std::filesystem::path& path,
                     const std::vector<std::string>& effects = {});

}  // namespace chaintrue::grid::files
