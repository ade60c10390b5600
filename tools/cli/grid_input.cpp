// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/grid_input.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "grid/files/grid_file.hpp"
#include "grid/files/machine_file.hpp"

namespace chaintrue::cli {

void add_grid_options(CLI::App& verb, GridInput& input) {
  verb.add_option("grid",
                  input.grid,
                  "The measured points: a chaintrue_grid file, or CSV; - is standard input")
      ->required();
  verb.add_option(
      "--machine", input.machine, "A chaintrue_machine file, in place of the grid's own");
  verb.add_option("--noise-length-mm",
                  input.length_noise_mm,
                  "One sigma of a chain length, in place of the grid's own");
  verb.add_option("--noise-position-mm",
                  input.position_noise_mm,
                  "One sigma of the tool's place on each axis, in place of the grid's own");
  verb.add_option("--noise-dof",
                  input.noise_dof,
                  "How well the noise is known, in degrees of freedom (15 where unsaid)");
}

grid::MeasuredGrid read_grid_input(const GridInput& input) {
  namespace files = grid::files;
  files::GridOptions options;
  if (!input.machine.empty()) options.machine = files::read_machine(input.machine);
  files::ReadGrid read = files::read_grid(input.grid, options);
  for (const files::Warning& warning : read.warnings) fmt::print(stderr, "{}\n", warning.message());
  if (input.length_noise_mm || input.position_noise_mm || input.noise_dof) {
    const grid::StatedNoise own = read.grid.noise.value_or(grid::StatedNoise{});
    read.grid.noise = grid::StatedNoise{input.length_noise_mm.value_or(own.length_mm),
                                        input.position_noise_mm.value_or(own.position_mm),
                                        input.noise_dof.value_or(own.dof)};
  }
  return std::move(read.grid);
}

}  // namespace chaintrue::cli
