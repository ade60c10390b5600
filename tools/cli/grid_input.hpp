// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The grid that a verb works on: its file, and what the command line puts beside it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "grid/measured_grid.hpp"

namespace chaintrue::cli {

struct GridInput {
  std::string grid;
  std::string machine;
  std::optional<double> length_noise_mm;
  std::optional<double> position_noise_mm;
  std::optional<double> noise_dof;
};

/// Adds GRID, --machine and the --noise options to a verb.
void add_grid_options(CLI::App& verb, GridInput& input);

/// Reads it all; warnings go to standard error. \throws files::InputError.
[[nodiscard]] grid::MeasuredGrid read_grid_input(const GridInput& input);

}  // namespace chaintrue::cli
