// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/simulate_options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <utility>

#include "grid/files/names.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/points_file.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::cli {
namespace {

template <class Enum>
Enum parse_word(std::string_view option,
                const std::string& word,
                const std::optional<Enum>& value,
                std::string expected,
                OptionProblems& problems) {
  if (!value) problems.add(option, word, std::move(expected), ProblemKind::unknown_word);
  return value.value_or(Enum{});
}

void parse_grid_size(const std::string& text, synthetic::Design& design, OptionProblems& problems) {
  const auto size = files::pair_of(text, 'x', 2, 1000);
  if (!size)
    return problems.add(
        "--grid", text, "columns x rows, each 2 to 1000, as in 7x4", ProblemKind::bad_syntax);
  design.columns = (*size)[0];
  design.rows = (*size)[1];
}

void parse_lattice(const SimulateOptions& options,
                   synthetic::Design& design,
                   OptionProblems& problems) {
  parse_grid_size(options.grid, design, problems);
  const auto kind = synthetic::design_kind(options.spacing);
  const bool lattice =
      kind == synthetic::DesignKind::regular || kind == synthetic::DesignKind::chebyshev;
  if (!lattice)
    problems.add("--spacing", options.spacing, "regular or chebyshev", ProblemKind::unknown_word);
  design.kind = lattice ? *kind : synthetic::DesignKind::regular;
}

synthetic::Region parse_region(const SimulateOptions& options, OptionProblems& problems) {
  return parse_word("--region",
                    options.region,
                    synthetic::region(options.region),
                    "whole, left, right, top or bottom",
                    problems);
}

synthetic::VisitingOrder parse_order(const SimulateOptions& options, OptionProblems& problems) {
  return parse_word("--order",
                    options.order,
                    synthetic::visiting_order(options.order),
                    "rows, columns, serpentine_rows, serpentine_columns or random",
                    problems);
}

synthetic::Design parse_design(const SimulateOptions& options, OptionProblems& problems) {
  synthetic::Design design;
  design.margin_mm = options.margin_mm;
  design.without_corners = options.without_corners;
  design.region = parse_region(options, problems);
  if (!options.marks.empty()) {
    design.kind = synthetic::DesignKind::given;
    design.given = files::read_points(options.marks);
  } else if (options.random_points != 0) {
    design.kind = synthetic::DesignKind::random;
    design.points = options.random_points;
  } else {
    parse_lattice(options, design, problems);
  }
  return design;
}

std::optional<StatedNoise> parse_stated(const SimulateOptions& options) {
  if (!options.stated_length_mm && !options.stated_position_mm && !options.stated_dof)
    return std::nullopt;
  StatedNoise stated;
  stated.length_mm = options.stated_length_mm.value_or(options.noise.length_mm);
  stated.position_mm = options.stated_position_mm.value_or(options.noise.position_mm);
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

model::Model parse_model(const std::string& word, OptionProblems& problems) {
  return parse_word("--model",
                    word,
                    files::named(files::kModels, word),
                    fmt::format("one of {}", fmt::join(files::words_of(files::kModels), ", ")),
                    problems);
}

std::vector<synthetic::SettingOffset> parse_offsets(const Words& arguments,
                                                    OptionProblems& problems) {
  std::vector<synthetic::SettingOffset> offsets;
  for (const std::string& argument : arguments) {
    const auto named = named_number(argument);
    const auto setting = named ? model::setting_from_name(named->name) : std::nullopt;
    if (!setting) {
      problems.add("--offset",
                   argument,
                   "setting=number, as in motor_left_x_mm=1.5",
                   ProblemKind::bad_syntax);
      continue;
    }
    offsets.push_back({*setting, named->value});
  }
  return offsets;
}

void check_words(const SimulateOptions& options, OptionProblems& problems) {
  // Belts have different effects and offsets, which simulate_belts.cpp checks.
  if (!options.belts.empty()) return;
  synthetic::Design design;
  if (!options.grid.empty()) parse_lattice(options, design, problems);
  (void)parse_region(options, problems);
  (void)parse_order(options, problems);
  (void)parse_model(options.model, problems);
  (void)parse_offsets(options.offsets, problems);
  // Valid effects depend on the machine only through its attachment and its existing effects. Effects
  // of --effects are known after their files are read.
  if (options.declared.empty())
    (void)parse_effects(options.effects, machine_for(options.effects), problems);
}

synthetic::SyntheticSpec parse_spec(const SimulateOptions& options, const Machine& machine) {
  OptionProblems problems;
  synthetic::SyntheticSpec spec;
  spec.design = parse_design(options, problems);
  spec.order = parse_order(options, problems);
  spec.repeats = options.repeats;
  spec.jitter_mm = options.jitter_mm;
  spec.noise = options.noise;
  spec.stated = parse_stated(options);
  spec.bad = options.bad;
  spec.hidden = parse_effects(options.effects, machine, problems);
  spec.offsets = parse_offsets(options.offsets, problems);
  spec.draw_settings = options.draw_settings;
  if (options.sheet_shift_mm || options.sheet_rotation_mrad) {
    grid::SheetUncertainty sheet;
    sheet.shift_mm = options.sheet_shift_mm.value_or(sheet.shift_mm);
    sheet.rotation_mrad = options.sheet_rotation_mrad.value_or(sheet.rotation_mrad);
    spec.sheet = sheet;
  }
  spec.model = parse_model(options.model, problems);
  spec.seed = options.seed;
  if (options.margin_mm) {
    const double half = 0.49 * std::min(machine.bed.width_mm, machine.bed.height_mm);
    problems.require("--margin-mm", *options.margin_mm, 0.0, half);
  }
  problems.throw_if_any();
  for (const model::MachineProblem& problem :
       problems_of(synthetic::truth_of(machine, spec).machine)) {
    problems.add("--offset",
                 fmt::format("{} = {}", problem.parameter, problem.value),
                 problem.expected,
                 ProblemKind::impossible);
  }
  problems.throw_if_any();
  return spec;
}

}  // namespace chaintrue::cli
