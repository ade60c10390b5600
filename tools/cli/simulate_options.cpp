// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/simulate_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "grid/files/names.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/points_file.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::cli {
namespace {

void take_size(const std::string& grid, synthetic::Design& design, OptionProblems& problems) {
  const auto size = files::pair_of(grid, 'x', 2, 1000);
  if (!size)
    return problems.add("--grid", grid, "columns x rows, each 2 to 1000, as in 7x4",
                        ProblemKind::bad_syntax);
  design.columns = (*size)[0];
  design.rows = (*size)[1];
}

synthetic::Design parse_design(const SimulateOptions& options, OptionProblems& problems) {
  synthetic::Design design = options.spec.design;
  if (!options.marks.empty()) {
    design.kind = synthetic::DesignKind::given;
    design.given = files::read_points(options.marks);
  } else if (options.random_points != 0) {
    design.kind = synthetic::DesignKind::random;
    design.points = options.random_points;
  } else {
    design.kind = options.spacing;
    take_size(options.grid, design, problems);
  }
  return design;
}

std::optional<StatedNoise> parse_stated(const SimulateOptions& options) {
  if (!options.stated_length_mm && !options.stated_position_mm && !options.stated_dof)
    return std::nullopt;
  StatedNoise stated;
  stated.length_mm = options.stated_length_mm.value_or(options.spec.noise.length_mm);
  stated.position_mm = options.stated_position_mm.value_or(options.spec.noise.position_mm);
  stated.dof = options.stated_dof.value_or(stated.dof);
  return stated;
}

/// With the attachment that these effects act on.
Machine machine_for(const Words& effects) {
  Machine machine;
  for (const std::string& argument : effects) {
    const model::effects::Effect* effect =
        model::effects::find_effect(std::string_view(argument).substr(0, argument.find(':')));
    if (effect != nullptr && effect->part == model::effects::Part::brackets)
      machine.attachment = model::Brackets{};
  }
  return machine;
}

}  // namespace

std::string SimulateOptions::title() const {
  return name.empty() ? fmt::format("simulated, seed {}", spec.seed) : name;
}

std::vector<synthetic::SettingOffset> parse_offsets(const Words& arguments,
                                                    OptionProblems& problems) {
  std::vector<synthetic::SettingOffset> offsets;
  for (const std::string& argument : arguments) {
    const auto named = named_number(argument);
    const auto setting = named ? model::setting_from_name(named->name) : std::nullopt;
    if (!setting) {
      problems.add("--offset", argument, "setting=number, as in motor_left_x_mm=1.5",
                   ProblemKind::bad_syntax);
      continue;
    }
    offsets.push_back({*setting, named->value});
  }
  return offsets;
}

void throw_if_impossible(const Machine& truth, OptionProblems& problems) {
  for (const model::MachineProblem& problem : problems_of(truth)) {
    problems.add("--offset", fmt::format("{} = {}", problem.parameter, problem.value),
                 problem.expected, ProblemKind::impossible);
  }
  problems.throw_if_any();
}

void require_bad_points(const SimulateOptions& options, std::size_t most, std::string_view what,
                        OptionProblems& problems) {
  const int bad = options.spec.bad.count;
  if (static_cast<std::size_t>(bad) <= most) return;
  problems.add("--bad-points", fmt::format("{}", bad),
               fmt::format("at most one for each of the {} {}", most, what),
               ProblemKind::out_of_range);
}

void check_words(const SimulateOptions& options, OptionProblems& problems) {
  // Belts have different effects and offsets, which simulate_belts.cpp checks.
  if (!options.belts.empty()) return;
  synthetic::Design design;
  if (!options.grid.empty()) take_size(options.grid, design, problems);
  (void)parse_offsets(options.offsets, problems);
  // Valid effects depend on the machine only through its attachment and its existing effects. Effects
  // of --effects are known after their files are read.
  if (options.declared.empty())
    (void)parse_effects(options.effects, machine_for(options.effects), problems);
}

synthetic::SyntheticSpec parse_spec(const SimulateOptions& options, const Machine& machine) {
  OptionProblems problems;
  synthetic::SyntheticSpec spec = options.spec;
  spec.design = parse_design(options, problems);
  spec.stated = parse_stated(options);
  spec.hidden = parse_effects(options.effects, machine, problems);
  spec.offsets = parse_offsets(options.offsets, problems);
  if (options.sheet_shift_mm || options.sheet_rotation_mrad) {
    grid::SheetUncertainty sheet;
    sheet.shift_mm = options.sheet_shift_mm.value_or(sheet.shift_mm);
    sheet.rotation_mrad = options.sheet_rotation_mrad.value_or(sheet.rotation_mrad);
    spec.sheet = sheet;
  }
  if (const auto& margin_mm = spec.design.margin_mm) {
    const double half = 0.49 * std::min(machine.bed.width_mm, machine.bed.height_mm);
    problems.require("--margin-mm", *margin_mm, 0.0, half);
  }
  problems.throw_if_any();
  throw_if_impossible(synthetic::truth_of(machine, spec).machine, problems);
  return spec;
}

}  // namespace chaintrue::cli
