// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/grid_input.hpp"

#include <fmt/format.h>

#include <cstdio>

#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/ranges.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/cli/effect_argument.hpp"
#include "tools/cli/machine_input.hpp"
#include "tools/cli/numbers.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/warnings.hpp"

namespace chaintrue::cli {

void add_grid_options(Verb verb, GridInput& input) {
  add_input(verb,
            "grid",
            input.grid,
            "The measured points: a chaintrue_grid file, or CSV; - is standard input")
      .required();
  add_input(
      verb, "--machine", input.machine, "A chaintrue_machine file, in place of the grid's own");
  add_number(verb,
             "--noise-length-mm",
             input.length_noise_mm,
             grid::files::kNoiseMm,
             "One sigma of a chain length, in place of the grid's own");
  add_number(verb,
             "--noise-position-mm",
             input.position_noise_mm,
             grid::files::kNoiseMm,
             "One sigma of the tool's place on each axis, in place of the grid's own");
  add_number(verb,
             "--noise-dof",
             input.noise_dof,
             grid::files::kNoiseDof,
             "How well the noise is known, in degrees of freedom (15 where unsaid)");
}

namespace {

namespace files = grid::files;

grid::MeasuredGrid grid_of(const std::string& text,
                           const GridInput& input,
                           files::GridOptions options) {
  files::ReadGrid read =
      files::parse_grid(text, files::name_in_messages(input.grid), std::move(options));
  print_warnings(read.warnings);
  if (input.length_noise_mm || input.position_noise_mm || input.noise_dof) {
    const grid::StatedNoise own = read.grid.noise.value_or(grid::StatedNoise{});
    read.grid.noise = grid::StatedNoise{input.length_noise_mm.value_or(own.length_mm),
                                        input.position_noise_mm.value_or(own.position_mm),
                                        input.noise_dof.value_or(own.dof)};
  }
  return std::move(read.grid);
}

void check_tape(const TapeInput& tape) {
  OptionProblems problems;
  if (tape.sigma_mm) problems.require("--tape-sigma-mm", *tape.sigma_mm, 0.001, 100.0);
  if (tape.hook_offset_mm)
    problems.require("--hook-offset-mm", *tape.hook_offset_mm, -1000.0, 1000.0);
  if (tape.hook_sigma_mm) problems.require("--hook-sigma-mm", *tape.hook_sigma_mm, 0.0, 100.0);
  if (tape.hole_sigma_mm) problems.require("--hole-sigma-mm", *tape.hole_sigma_mm, 0.0, 100.0);
  problems.throw_if_any();
}

}  // namespace

files::HolesOptions holes_options(const TapeInput& tape) {
  check_tape(tape);
  files::HolesOptions options;
  options.tape_sigma_mm = tape.sigma_mm;
  options.hook_offset_mm = tape.hook_offset_mm;
  options.hook_sigma_mm = tape.hook_sigma_mm;
  options.hole_sigma_mm = tape.hole_sigma_mm;
  return options;
}

namespace {

std::optional<model::Machine> machine_of(const GridInput& input) {
  if (input.machine.empty()) return std::nullopt;
  return read_machine_input(input.machine);
}

}  // namespace

void add_tape_options(Verb verb, TapeInput& input) {
  add_number(verb,
             "--tape-sigma-mm",
             input.sigma_mm,
             grid::files::kTapeSigmaMm,
             "Of holes: one sigma of a tape reading");
  add_number(verb,
             "--hook-offset-mm",
             input.hook_offset_mm,
             grid::files::kHookOffsetMm,
             "Of holes: every reading is longer than the distance by this much");
  add_number(verb,
             "--hook-sigma-mm",
             input.hook_sigma_mm,
             grid::files::kHoleSigmaMm,
             "Of holes: how well that is known, one sigma; exactly where unsaid");
  add_number(verb,
             "--hole-sigma-mm",
             input.hole_sigma_mm,
             grid::files::kHoleSigmaMm,
             "Of holes: one sigma of a hole beside where its chains put it, on each axis");
}

grid::MeasuredGrid read_grid_input(const GridInput& input) {
  files::GridOptions options;
  options.machine = machine_of(input);
  return grid_of(files::read_whole_file(input.grid), input, std::move(options));
}

std::variant<grid::MeasuredGrid, grid::MeasuredHoles> read_measured_input(
    const GridInput& input,
    const TapeInput& tape,
    MeasuredUse use,
    const model::Machine* otherwise) {
  const std::string text = input.text ? *input.text : files::read_whole_file(input.grid);
  if (!files::looks_like_holes(text)) {
    files::GridOptions options;
    options.machine = machine_of(input);
    if (otherwise != nullptr) options.otherwise = *otherwise;
    if (use == MeasuredUse::check) options.fewest_points = 1;
    return grid_of(text, input, std::move(options));
  }
  files::HolesOptions options = holes_options(tape);
  options.machine = machine_of(input);
  if (otherwise != nullptr) options.otherwise = *otherwise;
  if (use == MeasuredUse::check) options.fewest_distances = 1;
  files::ReadHoles read = files::parse_holes(text, files::name_in_messages(input.grid), options);
  if (read.belt_machine) {
    throw files::InputError({{files::name_in_messages(input.grid),
                              "/machine",
                              "a machine on four belts",
                              "holes that a machine on two chains cut; those of four belts go into "
                              "one fit with its lengths: chaintrue fit belts.json --with FILE"}});
  }
  print_warnings(read.warnings);
  return std::move(read.holes);
}

grid::Measured read_measured(const GridInput& input,
                             const TapeInput& tape,
                             const std::vector<std::string>& with,
                             MeasuredUse use) {
  grid::Measured measured;
  measured.add({files::name_in_messages(input.grid), read_measured_input(input, tape, use)});
  OptionProblems problems;
  for (const std::string& path : with) {
    GridInput other = input;
    other.grid = path;
    other.text.reset();
    // A few more readings are welcome beside enough of them.
    grid::MeasuredFile file{files::name_in_messages(path),
                            read_measured_input(other, tape, MeasuredUse::check)};
    const auto& machine = file.machine();
    if (machine && measured.machine()) {
      const std::string difference = grid::difference_of_settings(*measured.machine(), *machine);
      if (!difference.empty()) {
        problems.add(
            "--with", path, fmt::format("a file of the same machine as the first: {}", difference));
      }
    }
    measured.add(std::move(file));
  }
  problems.throw_if_any();
  return measured;
}

}  // namespace chaintrue::cli
