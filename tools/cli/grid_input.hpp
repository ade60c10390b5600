// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The grid, or the holes, that a verb works on: the file, and what the command line puts beside
/// it.
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "grid/files/holes_file.hpp"
#include "grid/observation/measured.hpp"
#include "tools/cli/arguments.hpp"

namespace chaintrue::cli {

struct GridInput {
  std::string grid;
  /// Of the file, where somebody has read it already.
  std::optional<std::string> text = std::nullopt;
  std::string machine;
  std::optional<double> length_noise_mm;
  std::optional<double> position_noise_mm;
  std::optional<double> noise_dof;
};

/// What a tape's file may leave unsaid.
struct TapeInput {
  std::optional<double> sigma_mm;
  std::optional<double> hook_offset_mm;
  std::optional<double> hook_sigma_mm;
  std::optional<double> hole_sigma_mm;
};

/// Adds GRID, --machine and the --noise options to a verb.
void add_grid_options(Verb verb, GridInput& input);

/// Reads it all; warnings go to standard error. \throws files::InputError.
[[nodiscard]] grid::MeasuredGrid read_grid_input(const GridInput& input);

/// Adds --tape-sigma-mm, --hook-offset-mm, --hook-sigma-mm and --hole-sigma-mm to a verb.
void add_tape_options(Verb verb, TapeInput& input);

/// What reading holes goes by of that. \throws files::InputError.
[[nodiscard]] grid::files::HolesOptions holes_options(const TapeInput& tape);

/// Enough for a fit, or for a check of what a map says.
enum class MeasuredUse { fit, check };

/// A grid or a set of holes, as the file is; `otherwise` is the machine of a file that names none,
/// where there is one. \throws files::InputError.
[[nodiscard]] std::variant<grid::MeasuredGrid, grid::MeasuredHoles> read_measured_input(
    const GridInput& input,
    const TapeInput& tape,
    MeasuredUse use,
    const model::Machine* otherwise = nullptr);

/// That and the files of --with: any mix of grids and holes of one machine, whose settings all that
/// state some share. \throws files::InputError.
[[nodiscard]] grid::Measured read_measured(const GridInput& input,
                                           const TapeInput& tape,
                                           const std::vector<std::string>& with,
                                           MeasuredUse use);

}  // namespace chaintrue::cli
