// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue effects: the catalogue as text, and the change that one effect makes to a machine.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "grid/files/answer_file.hpp"
#include "grid/files/effect_file.hpp"
#include "grid/files/ranges.hpp"
#include "model/reading_model.hpp"
#include "tools/cli/simulate_options.hpp"
#include "tools/cli/svg.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

struct EffectsOptions {
  std::string id;
  std::string machine;
  std::string side;
  Words values;
  StatedNoise noise;
  std::string drawing;
  /// A machine to draw every cause on, and the page.
  std::string atlas;
  std::string output;
  bool json = false;
  bool markdown = false;
  /// Files of declared effects.
  Words declared;
};

/// The machine to show an effect on, or any, with what is declared.
Machine machine_of(const EffectsOptions& options) {
  Machine machine = options.machine.empty() ? Machine{} : read_machine_input(options.machine);
  files::declare_effects(options.declared, machine);
  return machine;
}

std::string sides_of(const Effect& effect) {
  const auto sides = mapped(
      effect.sides, [](EffectSide side) { return side == EffectSide::none ? "-" : name(side); });
  return fmt::format("{}", fmt::join(sides, "|"));
}

/// The effects that may act on a machine.
std::vector<const Effect*> listed(const EffectsOptions& options) {
  const Machine machine = machine_of(options);
  return options.machine.empty() ? effects::listed_effects(machine) : effects::effects_of(machine);
}

void list_catalogue(const std::vector<const Effect*>& effects) {
  std::string_view heading;
  for (const Effect* effect : effects) {
    const std::string_view own = effect->law != nullptr ? "declared" : name(effect->station);
    if (own != heading) fmt::print("{}{}\n", heading.empty() ? "" : "\n", own);
    heading = own;
    fmt::print("  {}:{}:{}\n", effect->id, sides_of(*effect),
               fmt::join(mapped(effect->parameters, &EffectParameter::name), ","));
    fmt::print("      {}; usually {}\n", effect->cause, effect->typical);
  }
  fmt::print("\nOne of them: chaintrue effects ID [--machine M.json]\n");
}

void describe(const Effect& effect) {
  fmt::print("{} ({}, {})\n  cause         {}\n  shows as      {}\n  equation      {}\n", effect.id,
             name(effect.station), sides_of(effect), effect.cause, effect.signature,
             effect.equation);
  for (const EffectParameter& p : effect.parameters) {
    fmt::print("  {}  {}{}: {}, {} to {}, usually {}\n",
               p.role == ParameterRole::size ? "size        " : "place       ", p.name,
               p.symbol.empty() ? "" : fmt::format(" ({})", p.symbol), p.meaning,
               short_number(p.lower), short_number(p.upper), short_number(p.nominal));
  }
  fmt::print(
      "  usual size    {}\n  needs         {}\n  remedy        {}: {}\n  not modelled  {}\n"
      "  source        {}\n",
      effect.typical, name(effect.needs), name(effect.remedy_kind), effect.remedy,
      effect.not_modelled, effect.source);
}

// The arrow's glyph for a shift, a dot if it is below a hundredth of a millimetre.
std::string_view glyph(const Eigen::Vector2d& shift) {
  constexpr double kNothingMm = 0.005;
  constexpr std::string_view kArrows[] = {"→", "↗", "↑", "↖", "←", "↙", "↓", "↘"};
  if (shift.norm() < kNothingMm) return "·";
  const double eighths = std::atan2(shift.y(), shift.x()) / (std::numbers::pi / 4.0);
  return kArrows[as_size(std::lround(eighths) + 8) % 8];
}

template <class Member>
void print_bed(const synthetic::EffectPicture& picture, Member member) {
  const auto columns = as_size(picture.columns);
  fmt::print("      x");
  for (std::size_t k = 0; k < columns; ++k) fmt::print("{:>10.0f}", picture.marks[k].mark.x_mm);
  fmt::print("\n");
  for (std::size_t row = as_size(picture.rows); row-- > 0;) {
    fmt::print("  y{:>5.0f}", picture.marks[row * columns].mark.y_mm);
    for (std::size_t k = 0; k < columns; ++k) {
      const Eigen::Vector2d& shift = picture.marks[row * columns + k].*member;
      fmt::print("  {} {:>6.2f}", glyph(shift), shift.norm());
    }
    fmt::print("\n");
  }
}

void print_square(const synthetic::ShiftedSquare& square) {
  fmt::print(
      "  at ({:.0f}, {:.0f}): sides {:.3f} (bottom), {:.3f} (right), {:.3f} (top), {:.3f} (left); "
      "diagonals {:.3f} / and {:.3f} \\ (square: {:.3f})\n",
      square.centre.x_mm, square.centre.y_mm, square.side_mm[0], square.side_mm[1],
      square.side_mm[2], square.side_mm[3], square.diagonal_mm[0], square.diagonal_mm[1],
      square.size_mm * std::numbers::sqrt2);
}

std::string rival_words(const synthetic::Rival& rival) {
  const std::string side(name(rival.side));
  return fmt::format("{}{}", rival.effect->id, side.empty() ? "" : " " + side);
}

void print_strengths(const Effect& effect, const synthetic::EffectPicture& picture) {
  const EffectParameter& size = effect.parameters.front();
  fmt::print(
      "\nRequired size of {} (noise {} mm in length, {} mm in position; motors and zeros "
      "calibrated):\n",
      size.name, short_number(picture.noise.length_mm), short_number(picture.noise.position_mm));
  fmt::print("  {:>6}  {:>10}  {:>14}  {}\n", "points", "to show", "to be named", "nearest rival");
  for (const synthetic::StrengthAt& at : picture.strengths) {
    const synthetic::EffectStrength& s = at.strength;
    std::string nearest = s.nearest ? fmt::format("{} (the same to {:.4f})",
                                                  rival_words(*s.nearest), s.nearest->collinearity)
                                    : "none";
    for (const synthetic::Rival& same : s.inseparable) {
      nearest += fmt::format("; indistinguishable from {}", rival_words(same));
    }
    fmt::print("  {:>6}  {:>10}  {:>14}  {}\n", at.columns * at.rows,
               short_number(s.detectable_size),
               s.named_size ? short_number(*s.named_size) : "never", nearest);
  }
  fmt::print("  usual size {}; {:.0f} % of its effect remains after calibration with {} points\n",
             short_number(size.nominal), 100.0 * picture.strengths.front().strength.share_left,
             picture.strengths.front().columns * picture.strengths.front().rows);
}

std::map<std::string, double> parse_values(const EffectsOptions& options,
                                           OptionProblems& problems) {
  std::map<std::string, double> values;
  for (const std::string& argument : options.values) {
    const auto named = named_number(argument);
    if (named) {
      values[named->name] = named->value;
    } else {
      problems.add("--set", argument, "parameter=number", ProblemKind::bad_syntax);
    }
  }
  return values;
}

std::vector<double> chosen_values(const Effect& effect, EffectSide side,
                                  const EffectsOptions& options, const Machine& machine) {
  OptionProblems problems;
  AppliedEffect wanted = applied(effect, side, nominal_values(effect));
  for (const auto& [parameter, value] : parse_values(options, problems))
    wanted.parameters[parameter] = value;
  Machine with = machine;
  with.effects.push_back(wanted);
  for (const MachineProblem& problem : effects::problems_of_effects(with)) {
    problems.add("--set", problem.value, problem.expected, ProblemKind::impossible);
  }
  problems.throw_if_any();
  return mapped(effect.parameters, [&](const EffectParameter& parameter) {
    return wanted.parameters.at(std::string(parameter.name));
  });
}

EffectSide chosen_side(const Effect& effect, const std::string& word, OptionProblems& problems) {
  if (word.empty()) return effect.sides.front();
  for (const EffectSide side : effect.sides) {
    if (name(side) == word || (word == "-" && side == EffectSide::none)) return side;
  }
  problems.add("--side", word, fmt::format("one of {}", sides_of(effect)),
               ProblemKind::unknown_word);
  return EffectSide::none;
}

void check_options(const EffectsOptions& options, OptionProblems& problems) {
  // For an atlas the machine determines the causes.
  if (options.markdown || options.id.empty() || !options.atlas.empty()) return;
  (void)parse_values(options, problems);
  // Standard input is read once, and files of effects with it.
  const bool known_later = !options.declared.empty() || options.machine == "-";
  const auto is_declared = [&] {
    return !options.machine.empty() &&
           effects::find_effect(machine_of(options), options.id) != nullptr;
  };
  if (const Effect* effect = effects::find_effect(options.id)) {
    (void)chosen_side(*effect, options.side, problems);
  } else if (!known_later && !is_declared()) {
    problems.add("effect", options.id, "an effect that `chaintrue effects` lists",
                 ProblemKind::unknown_word);
  }
}

/// Marks over the bed where the machine, with or without the effect, cannot hold the sled.
std::optional<std::string> unreachable(const Machine& machine, const AppliedEffect& effect) {
  Machine with = machine;
  with.effects.push_back(effect);
  for (const Machine* one : {&machine, static_cast<const Machine*>(&with)}) {
    const ReadingModel model(*one);
    for (const auto& [columns, rows] : {std::pair{7, 4}, std::pair{10, 6}, std::pair{20, 10}}) {
      for (const model::Visit& visit : synthetic::regular_session(machine, columns, rows)) {
        const auto reading = model.at(visit.position);
        if (reading && reading->position_jacobian.allFinite()) continue;
        return fmt::format(
            "the sled cannot be held at ({:.0f}, {:.0f}) mm of this bed: {}. Check the motors, "
            "which the file puts at ({:.0f}, {:.0f}) mm (left) and ({:.0f}, {:.0f}) mm (right)",
            visit.position.x_mm, visit.position.y_mm,
            reading ? "the chains do not determine its place" : reading.error().sentence(),
            machine.motors.left.x_mm, machine.motors.left.y_mm, machine.motors.right.x_mm,
            machine.motors.right.y_mm);
      }
    }
  }
  return std::nullopt;
}

int show_picture(const Effect& effect, const EffectsOptions& options, const Machine& machine) {
  OptionProblems sound;  // check_options has checked the catalogue's effects
  const EffectSide side = chosen_side(effect, options.side, sound);
  sound.throw_if_any();
  const std::vector<double> values = chosen_values(effect, side, options, machine);
  if (const auto why = unreachable(machine, effects::applied(effect, side, values))) {
    say("{}: {}", options.machine, *why);
    return kNotSupportedOrOutside;
  }
  const synthetic::EffectPicture picture =
      synthetic::picture_effect(machine, effect, side, values, options.noise);
  if (!options.drawing.empty()) write_output(options.drawing, draw_effect(machine, picture));
  end_progress();
  if (options.json) {
    fmt::print("{}", files::write_effect_picture(picture));
    return kDone;
  }
  describe(effect);
  fmt::print("\nOn \"{}\" with {}{}{}", machine.name, effect.id,
             picture.applied.side.empty() ? "" : " ", picture.applied.side);

  for (const auto& [key, value] : picture.applied.parameters)
    fmt::print(", {} = {}", key, short_number(value));
  fmt::print("\nerror of the tool in mm (marks visited row by row):\n");
  print_bed(picture, &synthetic::ShiftedMark::as_stated_mm);
  fmt::print("and, once motors and zeros are calibrated on these marks, still by\n");
  print_bed(picture, &synthetic::ShiftedMark::calibrated_mm);
  fmt::print("\nA square of 100 mm, with the machine file as it is, mm\n");
  for (const synthetic::ShiftedSquare& square : picture.squares) print_square(square);
  print_strengths(effect, picture);
  return kDone;
}

int run_effects(const EffectsOptions& options) {
  if (options.markdown) {
    fmt::print("{}", effects::catalogue_document());
    return kDone;
  }
  if (!options.atlas.empty())
    return write_atlas(options.atlas, options.id, options.declared, options.output);
  if (options.id.empty() && options.json) {
    fmt::print("{}", files::write_catalogue(listed(options)));
    return kDone;
  }
  if (options.id.empty()) {
    list_catalogue(listed(options));
    say_next({"effects", std::string(effects::catalogue().front()->id)});
    return kDone;
  }
  const Machine machine = machine_of(options);
  const Effect* effect = effects::find_effect(machine, options.id);
  if (effect == nullptr) {
    refuse("command line", "effect", options.id,
           "an effect that `chaintrue effects` lists, or that --effects declares",
           ProblemKind::unknown_word);
  }
  if (!options.machine.empty()) return show_picture(*effect, options, machine);
  describe(*effect);
  // The effect is shown on a machine, so one is required.
  say_next({"start"});
  return kDone;
}

}  // namespace

void add_effects(Verb app) {
  auto [verb, c] = app.add_verb<EffectsOptions>(
      "effects", "List the catalogue of effects, or show what one of them does to a machine",
      R"(Examples:
  build/chaintrue effects
  build/chaintrue effects --atlas fixtures/plotter/mural.txt -o atlas.html
  build/chaintrue effects chain_stretch --machine fixtures/machines/classic.json --draw stretch.svg)",
      run_effects);
  verb.has({{"id", c.id, "Effect; without it the catalogue is listed"},
            {"--machine", reads(c.machine), "chaintrue_machine file of the machine to show it on"},
            {"--side", c.side, "left, right, both, x or y; by default the effect's first"},
            {"--set", c.values, "Size as parameter=number instead of the usual one"},
            {"--length-noise-mm", {c.noise.length_mm, {"mm", 1e-6, 100.0}}, "One sigma"},
            {"--position-noise-mm", {c.noise.position_mm, files::kNoiseMm}, "One sigma"},
            {"--draw", writes(c.drawing, {Origin::drawing}), "Also write it as an SVG picture"},
            {"--json", c.json, "For programs"},
            {"--markdown", c.markdown, "Print the catalogue as in docs/effects.md"},
            {"--effects", reads(c.declared),
             "chaintrue_effect files: declared effects, in addition to the catalogue's"},
            {"--atlas", reads(c.atlas),
             "Write a page with a picture of each cause for a machine with two chains, four "
             "belts or a pen; with the name of an effect or a setting, only that one"},
            {"-o,--output", writes(c.output, {Origin::page}), "The page (HTML) of --atlas"}});
  verb.needs({"--side", "--set", "--length-noise-mm", "--position-noise-mm", "--draw"},
             "--machine");
  verb.excludes({"--effects"}, "--markdown");
  verb.excludes({"--machine", "--json", "--markdown"}, "--atlas");
  verb.needs({"--output"}, "--atlas");
  verb.needs({"--atlas"}, "--output");
  add_option_check(verb, c, check_options);
}

}  // namespace chaintrue::cli
