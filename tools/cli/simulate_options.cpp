// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/simulate_options.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <string_view>

#include "grid/files/names.hpp"
#include "grid/files/number_text.hpp"
#include "grid/files/points_file.hpp"
#include "model/calibration/setting.hpp"
#include "model/effects/catalogue.hpp"

namespace chaintrue::cli {

namespace {

void take_size(const std::string& grid, synthetic::Design& design, OptionProblems& problems) {
  take_size(grid, 1000, "columns x rows, each 2 to 1000, as in 7x4", design, problems);
}

synthetic::Design parse_design(const SimulateOptions& options, OptionProblems& problems) {
  synthetic::Design design = options.spec.design;
  if (!options.marks.empty()) {
    design.kind = DesignKind::given;
    design.given = files::read_points(options.marks);
  } else if (options.random_points != 0) {
    design.kind = DesignKind::random;
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
    const Effect* effect =
        effects::find_effect(std::string_view(argument).substr(0, argument.find(':')));
    if (effect != nullptr && effect->part == effects::Part::brackets)
      machine.attachment = model::Brackets{};
  }
  return machine;
}

}  // namespace

std::string SimulateOptions::title() const {
  return name.empty() ? fmt::format("simulated, seed {}", spec.seed) : name;
}

std::vector<SettingOffset> parse_offsets(const Words& arguments, OptionProblems& problems) {
  std::vector<SettingOffset> offsets;
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
  for (const MachineProblem& problem : problems_of(truth)) {
    problems.add("--offset", fmt::format("{} = {}", problem.parameter, problem.value),
                 problem.expected, ProblemKind::impossible);
  }
  problems.throw_if_any();
}

void require_bad_points(const SimulateOptions& options, std::size_t most, std::string_view what,
                        OptionProblems& problems) {
  const int bad = options.spec.bad.count;
  if (as_size(bad) <= most) return;
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
  throw_if_impossible(truth_of(machine, spec).machine, problems);
  return spec;
}

namespace {

constexpr std::string_view kForm = "id:side:key=value,key=value, with - for no side";

// Cuts `text` at its first `mark`; the rest is empty if there is none.
std::string_view take_until(std::string_view& text, char mark) {
  const std::size_t end = text.find(mark);
  const std::string_view taken = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view{} : text.substr(end + 1);
  return taken;
}

std::optional<AppliedEffect> parse_form(const std::string& argument, OptionProblems& problems) {
  std::string_view rest = argument;
  AppliedEffect effect;
  effect.effect = take_until(rest, ':');
  effect.side = take_until(rest, ':');
  if (effect.side == "-") effect.side.clear();
  if (rest.empty()) {
    problems.add("--effect", argument, std::string(kForm), ProblemKind::bad_syntax);
    return std::nullopt;
  }
  while (!rest.empty()) {
    std::string_view value = take_until(rest, ',');
    const std::string key(take_until(value, '='));
    const auto number = files::number_of(value);
    if (!number) {
      problems.add("--effect", argument, fmt::format("a number after {}=, as in {}", key, kForm),
                   ProblemKind::not_a_number);
      return std::nullopt;
    }
    if (!effect.parameters.emplace(key, *number).second) {
      problems.add("--effect", argument, fmt::format("{} once", key), ProblemKind::repeated_key);
      return std::nullopt;
    }
  }
  return effect;
}

}  // namespace

std::vector<AppliedEffect> parse_effect_words(const Words& arguments, OptionProblems& problems) {
  return mapped(arguments, [&](const std::string& argument) {
    return parse_form(argument, problems).value_or(AppliedEffect{});
  });
}

std::vector<AppliedEffect> parse_effects(const Words& arguments, const Machine& machine,
                                         OptionProblems& problems) {
  std::vector<AppliedEffect> effects;
  Machine with = machine;
  std::vector<const std::string*> origin(machine.effects.size(), nullptr);
  for (const std::string& argument : arguments) {
    const auto effect = parse_form(argument, problems);
    if (!effect) continue;
    effects.push_back(*effect);
    with.effects.push_back(*effect);
    origin.push_back(&argument);
  }
  for (const MachineProblem& problem : effects::problems_of_effects(with)) {
    // "/effects/3/side": 3 is the argument's number.
    std::string_view place =
        std::string_view(problem.parameter).substr(std::string_view("/effects/").size());
    const std::string_view index_text = take_until(place, '/');
    std::size_t index = 0;
    std::from_chars(index_text.data(), index_text.data() + index_text.size(), index);
    if (index < origin.size() && origin[index] != nullptr) {
      const std::string what = place.empty() ? "" : fmt::format(" ({})", place);
      problems.add("--effect",
                   problem.value.empty() ? *origin[index]
                                         : fmt::format("{} in {}", problem.value, *origin[index]),
                   problem.expected + what, ProblemKind::impossible);
    }
  }
  return effects;
}

std::optional<NamedNumber> named_number(std::string_view text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string_view::npos) return std::nullopt;
  const auto value = files::number_of(text.substr(equals + 1));
  if (!value) return std::nullopt;
  return NamedNumber{std::string(text.substr(0, equals)), *value};
}

}  // namespace chaintrue::cli
