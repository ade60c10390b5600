// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The grid or the holes of a verb: the file, and the options that supplement it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/files/measured_options.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/observation/measured.hpp"
#include "tools/cli/input_file.hpp"

namespace chaintrue::cli {

struct GridInput {
  std::string grid;
  std::string machine;
  std::optional<double> length_noise_mm;
  std::optional<double> position_noise_mm;
  std::optional<double> noise_dof;
  /// Readings are in inches, in tables whose header says mm.
  bool inches = false;
  /// Files of declared effects.
  Words effects;
};

/// Adds GRID, --machine and the --noise options to a verb.
void add_grid_options(Verb verb, GridInput& input);

/// For measured files: those of two chains, whether it is a single grid, and whether any of them is a
/// table.
Facts facts_of(const InputFiles& files);

/// --effects: declared effects may act on the machine of every input file.
OptionRow effects_row(GridInput& input);

/// Reads all inputs; warnings go to standard error. \throws InputError.
MeasuredGrid read_grid_input(const GridInput& input);

/// Adds --tape-sigma-mm, --hook-offset-mm, --hook-sigma-mm and --hole-sigma-mm to a verb.
void add_tape_options(Verb verb, files::TapeOptions& input);

/// --without, for a verb that reads belts.
[[nodiscard]] OptionRow without_row(std::string& without);
/// Its points, from 1. \throws InputError.
std::vector<std::size_t> points_left_out(const std::string& without);

/// Enough data for a fit, or only for a check of a map.
enum class MeasuredUse { fit, check };

/// A grid or a set of holes, as the file is; `otherwise` is the machine for a file that names none,
/// if available. \throws InputError.
grid::MeasuredFile load_measured(const InputFile& file, const GridInput& input,
                                 const files::TapeOptions& tape, MeasuredUse use,
                                 const Machine* otherwise = nullptr);

/// The first file and those of --with: any mix of grids and holes of one machine, with equal stated
/// settings. \throws InputError.
grid::Measured load_measured(const InputFiles& files, const GridInput& input,
                             const files::TapeOptions& tape, MeasuredUse use);

struct ReadingCounts {
  std::size_t points = 0;
  std::size_t distances = 0;
  std::size_t holes = 0;
};
/// Counts the readings of all files together.
ReadingCounts counts_of(const grid::Measured& measured);

/// The file, and those of --with.
InputFiles open_inputs(const std::string& path, const Words& with);

// --outside and --fade-mm: a map's continuation beyond its points, shared by several verbs.

struct OutsideOption {
  std::string way;
  double fade_width_mm = grid::OutsideRule{}.fade_width_mm;
};

/// \param usual what happens without the option, in words
void add_outside_options(Verb verb, OutsideOption& option, const std::string& usual);
/// The requested rule, or the given one.
grid::OutsideRule rule_of(const OutsideOption& option, const grid::OutsideRule& usual);

}  // namespace chaintrue::cli
