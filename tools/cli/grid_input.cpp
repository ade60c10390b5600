// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/input_file.hpp"

#include <fmt/format.h>

#include "grid/files/effect_file.hpp"
#include "grid/files/grid_file.hpp"
#include "grid/files/holes_file.hpp"
#include "grid/files/names.hpp"
#include "grid/files/ranges.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"

namespace chaintrue::cli {

void add_grid_options(Verb verb, GridInput& input) {
  verb.has(
      {{"grid", required(reads(input.grid)),
        "Measured points: a chaintrue_grid file or a CSV table; - is standard input"},
       {"--machine", reads(input.machine),
        "A chaintrue_machine file that replaces the grid's own machine", facts::chains | facts::map,
        "to be left out, because the files of belts and drawings contain their machine"},
       {"--noise-length-mm",
        {input.length_noise_mm, files::kNoiseMm},
        "Standard deviation (1 sigma) of a measured chain length; replaces the grid's",
        facts::grid,
        "to be left out, because it applies to chain lengths in a grid only"},
       {"--noise-position-mm",
        {input.position_noise_mm, files::kNoiseMm},
        "Standard deviation (1 sigma) of a measured position on each axis; replaces the grid's",
        facts::grid,
        "to be left out, because it applies to positions in a grid only"},
       {"--noise-dof",
        {input.noise_dof, files::kNoiseDof},
        "Degrees of freedom of the noise; a higher number means that it is better known (15 "
        "by default)",
        facts::grid,
        "to be left out, because it applies to the noise of a grid only"},
       {"--inches", input.inches,
        "In CSV tables, measured positions, lengths and distances are in inches, as "
        "43.8125 or 43 13/16; commands stay in mm",
        facts::table,
        "to be left out, because it applies to CSV tables only; the numbers of a JSON file "
        "are in mm"}});
}

OptionRow effects_row(GridInput& input) {
  return {"--effects", reads(input.effects),
          "chaintrue_effect files: declared causes, tested along with the catalogue's",
          facts::chains, "to be left out, because declared effects act on two chains"};
}

namespace {

void declare(const GridInput& input, const std::string& file, std::optional<Machine>& machine) {
  if (input.effects.empty()) return;
  if (machine) return files::declare_effects(input.effects, *machine);
  refuse("command line", "--effects", input.effects.front(),
         fmt::format("to be left out, or --machine, because {} has no machine", file),
         ProblemKind::contradiction);
}

MeasuredGrid grid_of(const InputFile& file, const GridInput& input,
                     const files::MeasuredOptions& options) {
  files::ReadGrid read = files::parse_grid(file.text, file.name, options);
  print_warnings(read.warnings);
  declare(input, file.name, read.grid.machine);
  if (input.length_noise_mm || input.position_noise_mm || input.noise_dof) {
    const StatedNoise own = read.grid.noise.value_or(StatedNoise{});
    read.grid.noise = StatedNoise{input.length_noise_mm.value_or(own.length_mm),
                                  input.position_noise_mm.value_or(own.position_mm),
                                  input.noise_dof.value_or(own.dof)};
  }
  return std::move(read.grid);
}

}  // namespace

Facts facts_of(const InputFiles& files) {
  Facts facts = facts::nothing;
  for (const InputFile& file : files) {
    facts |= file.fact() & facts::chains;
    if (!is_json(file.text)) facts |= facts::table;
  }
  const bool is_one_grid = files.size() == 1 && (facts & facts::grid) != 0;
  return is_one_grid ? facts | facts::one_grid : facts;
}

namespace {

std::optional<Machine> machine_of(const GridInput& input) {
  if (input.machine.empty()) return std::nullopt;
  return read_machine_input(input.machine);
}

}  // namespace

void add_tape_options(Verb verb, TapeOptions& input) {
  verb.has({{"--tape-sigma-mm",
             {input.sigma_mm, files::kTapeSigmaMm},
             "Holes: standard deviation (1 sigma) of a tape reading",
             facts::taped,
             "to be left out, because it applies to the tape for holes only"},
            {"--hook-offset-mm",
             {input.zero_offset_mm, files::kTapeZeroOffsetMm},
             "Holes: the tape's zero error; every reading is longer than the distance by this much",
             facts::taped,
             "to be left out, because it applies to the tape for holes only"},
            {"--hook-sigma-mm",
             {input.zero_offset_sigma_mm, files::kHoleSigmaMm},
             "Holes: standard deviation (1 sigma) of the zero error, 3 mm by default; 0 if it is "
             "known exactly",
             facts::taped,
             "to be left out, because it applies to the tape for holes only"},
            {"--hole-sigma-mm",
             {input.hole_sigma_mm, files::kHoleSigmaMm},
             "Holes: standard deviation (1 sigma) of a hole's position on each axis, as the drill "
             "wanders",
             facts::taped,
             "to be left out, because it applies to holes only"}});
}

MeasuredGrid read_grid_input(const GridInput& input) {
  const InputFile file = open_input(input.grid);
  require_kind(file, {FileKind::grid});
  return grid_of(file, input, {.machine = machine_of(input), .inches = input.inches});
}

MeasuredFile load_measured(const InputFile& file, const GridInput& input, const TapeOptions& tape,
                           MeasuredUse use, const Machine* otherwise) {
  require_kind(file, {FileKind::grid, FileKind::holes});
  files::MeasuredOptions options{.machine = machine_of(input),
                                 .few = use == MeasuredUse::check,
                                 .inches = input.inches,
                                 .tape = tape};
  if (otherwise != nullptr) options.otherwise = *otherwise;
  if (file.kind == FileKind::grid) return {file.name, grid_of(file, input, options)};
  files::ReadHoles read = files::parse_holes(file.text, file.name, options);
  print_warnings(read.warnings);
  declare(input, file.name, read.holes.machine);
  return {file.name, std::move(read.holes)};
}

ReadingCounts counts_of(const Measured& measured) {
  ReadingCounts counts;
  for (const auto* grid : measured.grids()) counts.points += grid->points.size();
  for (const auto* set : measured.holes()) {
    counts.distances += set->distances.size();
    counts.holes += set->holes.size();
  }
  return counts;
}

InputFiles open_inputs(const std::string& path, const Words& with) {
  InputFiles files = {open_input(path)};
  for (const std::string& other : with) files.push_back(open_input(other));
  return files;
}

Measured load_measured(const InputFiles& files, const GridInput& input, const TapeOptions& tape,
                       MeasuredUse use) {
  Measured measured;
  measured.add(load_measured(files.front(), input, tape, use));
  OptionProblems problems;
  for (std::size_t k = 1; k < files.size(); ++k) {
    // A further file may have few readings: the first has enough of them.
    MeasuredFile other = load_measured(files[k], input, tape, MeasuredUse::check);
    const auto& machine = other.machine();
    if (machine && measured.machine()) {
      const std::string difference = grid::difference_of_settings(*measured.machine(), *machine);
      if (!difference.empty()) {
        problems.add("--with", files[k].path,
                     fmt::format("a file of the same machine as the first: {}", difference),
                     ProblemKind::contradiction);
      }
    }
    for (std::size_t before = 0; before < k; ++before) {
      if (same_readings(measured.files()[before], other)) {
        problems.add("--with", files[k].path,
                     fmt::format("another session: it has exactly the same readings as {}",
                                 files[before].path),
                     ProblemKind::repeated_value);
      }
    }
    measured.add(std::move(other));
  }
  problems.throw_if_any();
  return measured;
}

OptionRow without_row(std::string& without) {
  return {"--without", without,
          "Points of a chaintrue_belts file to leave out, numbered from 1 as in messages, "
          "such as 7,12",
          facts::belts,
          "to be left out, because it applies to chaintrue_belts files only; remove points of "
          "other files from the file"};
}

std::vector<std::size_t> points_left_out(const std::string& without) {
  return without.empty() ? std::vector<std::size_t>{}
                         : files::point_numbers_of(without, "--without");
}

void add_outside_options(Verb verb, OutsideOption& option, const std::string& usual) {
  verb.has({{"--outside",
             {option.way, files::kOutsideWays},
             "Beyond the measured points: continued (smoothly), refuse, fade (to the machine "
             "without correction), linear or clamp; " +
                 usual},
            {"--fade-mm",
             {option.fade_width_mm, files::kFadeWidthMm},
             "Distance over which --outside fade ends the correction",
             facts::fade,
             "to be left out without --outside fade"}});
}

grid::OutsideRule rule_of(const OutsideOption& option, const grid::OutsideRule& usual) {
  if (option.way.empty()) return usual;
  return {*files::named(files::kOutsideWays, option.way), option.fade_width_mm};
}

}  // namespace chaintrue::cli
