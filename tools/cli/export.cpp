// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue export: a machine, or what was measured of it, as the numbers that another program
/// wants typed in.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "grid/files/anchors_file.hpp"
#include "grid/files/controller_settings.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/controller_error.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "tools/cli/export_klipper.hpp"
#include "tools/cli/export_linuxcnc.hpp"
#include "tools/cli/export_plotter.hpp"
#include "tools/cli/export_straight.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/option_rules.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/settings_file.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct ExportCommand {
  std::string input;
  std::string output = "-";
  /// The map that is right once the numbers are typed in.
  std::string map_after;
};

/// The numbers, and what is said of them.
struct Exported {
  files::GroundcontrolText settings;
  std::string words;
  std::vector<std::string> next;
  /// Of a map: it with the controller that holds the numbers.
  std::optional<grid::CompensationMap> map_after = std::nullopt;
  bool is_refused = false;  ///< the reason was said
};

/// What the machine says otherwise than its controller.
Exported of_machine(const model::Machine& machine, std::vector<std::string> next) {
  return {files::write_groundcontrol(machine), "", std::move(next)};
}

std::vector<std::string> settings_page(const std::string& path) {
  return {"report", path, "-o", std::filesystem::path(path).replace_extension(".html").string()};
}

/// The controller that holds the numbers of such a text.
model::Controller controller_of(const files::GroundcontrolText& settings,
                                model::ControllerKind kind,
                                const std::string& file) {
  model::Controller typed = files::parse_groundcontrol(settings.text, file).machine.controller;
  if (kind == model::ControllerKind::holey) typed.kind = kind;
  return typed;
}

/// Of a map whose controller bears no settings: all numbers of its calibrated machine.
Exported of_not_converged(const grid::CompensationMap& map, const ExportCommand& command) {
  const model::Machine& machine = *map.machine();
  const std::string& path = command.input;
  Exported result = of_machine(machine, settings_page(path));
  if (command.map_after.empty() ||
      machine.controller.kind == model::ControllerKind::fluidnc_wallplotter)
    return result;
  result.map_after =
      grid::map_for_settings(map,
                             controller_of(result.settings, machine.controller.kind, path),
                             "For a controller that holds the numbers of export groundcontrol.");
  return result;
}

/// What leads on: type in, check with the map after, cut with it.
std::vector<std::string> next_of(const ExportCommand& command, bool is_worth_typing) {
  const std::string& map = command.input;
  if (!is_worth_typing) return settings_page(map);
  if (!command.map_after.empty()) return {"plan", "--check", command.map_after, "-o", "check.csv"};
  return {"export", "groundcontrol", map, "-o", "settings.ini", "--map-after", after_name(map)};
}

/// The tool's error today as every verb says it; where the sheet was laid by hand, its part is no
/// matter of the numbers.
std::string today_in_words(const grid::CompensationMap& map, const grid::SettingsToType& typed) {
  const grid::ErrorSummary today = grid::error_in_use(map).value_or(typed.as_it_is);
  return fmt::format(
      "With today's settings the tool is {:.2f} mm rms off over the measured part, {:.2f} mm at "
      "worst{}",
      today.rms_mm,
      today.maximum_mm,
      has_placed_sheet(map.contents())
          ? fmt::format(" ({:.2f} and {:.2f} mm, had the sheet lain where it should)",
                        typed.as_it_is.rms_mm,
                        typed.as_it_is.maximum_mm)
          : "");
}

std::string words_of(const grid::CompensationMap& map,
                     const grid::SettingsToType& typed,
                     const ExportCommand& command) {
  if (!typed.worth_typing) {
    return fmt::format("{}; other numbers would gain less than a tenth, so keep yours.\n",
                       today_in_words(map, typed));
  }
  return fmt::format(
      "{}; with these numbers {:.2f} and {:.2f} mm. The rest is corrected by gcode compensate "
      "with the map.\n{}",
      today_in_words(map, typed),
      typed.typed.rms_mm,
      typed.typed.maximum_mm,
      command.map_after.empty()
          ? "Once they are typed in, this map is out of date; --map-after writes the one to use "
            "then.\n"
          : fmt::format("Type them in, measure five marks and check them with {0}. Cut as the "
                        "programs are, or truer, compensated with {0}: not with {1} any more.\n",
                        command.map_after,
                        command.input));
}

/// What the controller's formulas can make of the map.
Exported of_map(const grid::CompensationMap& map,
                const std::string& file,
                const ExportCommand& command) {
  const model::Machine* machine = map.machine();
  if (machine != nullptr && !machine->controller.settings.motor_spacing_mm)
    return of_not_converged(map, command);
  const auto typed = grid::settings_to_type(map);
  if (!typed) throw files::InputError({{file, "", "this map", typed.error().sentence()}});
  Exported result{
      files::write_groundcontrol_settings(
          *machine, typed->settings, fmt::format("the {} points of {}", typed->points, file)),
      words_of(map, *typed, command),
      next_of(command, typed->worth_typing),
      map};
  if (typed->worth_typing) {
    const model::Controller now{machine->controller.kind, typed->settings};
    model::Machine after = *machine;
    after.controller = now;
    result.map_after = grid::map_for_settings(
        map,
        now,
        fmt::format("For a controller that holds the numbers of export groundcontrol ({}).",
                    files::in_words(files::changed_settings(files::settings_in_force(*machine),
                                                            files::settings_in_force(after)))));
  }
  return result;
}

/// Causes that the settings of a diagnosis' machine depend on, and that are not sure enough for that.
std::vector<std::string> weak_causes(const grid::diagnosis::Diagnosis& found) {
  using grid::diagnosis::Cause;
  std::vector<model::AppliedEffect> taken = found.extended_machine.effects;
  taken.insert(taken.end(), found.data_corrections.begin(), found.data_corrections.end());
  std::vector<std::string> weak;
  for (const Cause& cause : found.causes) {
    const bool is_taken = std::any_of(taken.begin(), taken.end(), [&](const auto& effect) {
      return effect.effect == cause.cause.effect->id &&
             effect.side == model::effects::name(cause.cause.side);
    });
    if (!is_taken || cause.probability >= grid::diagnosis::kSureOfCause) continue;
    weak.push_back(fmt::format("{}{} ({})",
                               cause.cause.effect->cause,
                               grid::diagnosis::side_words(cause.cause),
                               grid::diagnosis::percent(cause.probability)));
  }
  return weak;
}

/// True, with a message, where numbers would depend on a cause that may not act.
bool refuses_weak_causes(const grid::diagnosis::Diagnosis& found, const std::string& name) {
  const std::vector<std::string> weak = weak_causes(found);
  if (weak.empty()) return false;
  fmt::print(
      stderr,
      "{}: this machine rests on {}; to type numbers in, a cause must be at least {} sure. Measure "
      "what the diagnosis asks for next and diagnose again; --force goes on all the same.\n",
      name,
      grid::diagnosis::joined(weak, "and"),
      grid::diagnosis::percent(grid::diagnosis::kSureOfCause));
  return true;
}

/// JSON that does not say what it is: somebody's machine, whose reader says what is missing.
bool is_untyped_json(const InputFile& file) {
  return file.kind == FileKind::other && files::is_json(file.text) &&
         files::file_type_of(file.text, file.name).empty();
}

[[noreturn]] void refuse_drawing(const InputFile& file) {
  throw files::InputError(
      {{file.name,
        "/observations",
        "a diagnosis of a test drawing",
        "one of another machine; of a V-plotter export plotter has the lines, from what fit makes of "
        "the drawing"}});
}

Exported export_of(const InputFile& file, const ExportCommand& command, bool forced) {
  if (is_untyped_json(file)) return of_machine(load_machine(file), {});
  require_kind(
      file,
      {FileKind::machine, FileKind::map, FileKind::diagnosis},
      file.kind == FileKind::anchors ? "anchors of four belts are taken by export maslow4" : "");
  if (file.kind == FileKind::map) {
    const grid::CompensationMap map = load_map(file);
    if (!forced && refuses_to_cut_with(map)) return Exported{{}, "", {}, std::nullopt, true};
    return of_map(map, file.name, command);
  }
  if (file.kind == FileKind::diagnosis) {
    const grid::diagnosis::Diagnosis found = load_diagnosis(file);
    if (found.drawing) refuse_drawing(file);
    if (found.belts) {
      throw files::InputError(
          {{file.name,
            "/observations",
            "a diagnosis of four belts",
            "one of a machine on chains; of belts export maslow4 has the lines"}});
    }
    if (!forced && refuses_weak_causes(found, file.name))
      return Exported{{}, "", {}, std::nullopt, true};
    return of_machine(found.extended_machine, settings_page(file.path));
  }
  return of_machine(load_machine(file), {"plan", "--machine", file.path, "-o", "marks.csv"});
}

Facts facts_of(const InputFile& file) {
  if (file.kind == FileKind::map) return facts::map;
  return file.kind == FileKind::diagnosis ? facts::diagnosis : facts::machine;
}

/// \throws files::InputError where no such map follows.
std::string written_map_after(Verb verb, const Exported& exported, const ExportCommand& command) {
  if (command.map_after.empty()) return "";
  if (exported.map_after) return files::write_map(*exported.map_after, made_by(verb));
  throw files::InputError(
      {{command.input,
        "",
        "a map of a controller that takes none of GroundControl's numbers",
        "--map-after to be left out: put the machine's anchors into FluidNC's config.yaml, and "
        "compensate with this map and --settings config.yaml"}});
}

int export_groundcontrol(Verb verb, const ExportCommand& command) {
  const InputFile file = open_input(command.input);
  const Exported exported = export_of(file, command, verb.is_given("--force"));
  refuse_what_does_nothing(verb, facts_of(file));
  if (exported.is_refused) return kCheckFailed;
  write_outputs({{command.map_after, written_map_after(verb, exported, command)},
                 {command.output, exported.settings.text}});
  for (const std::string& remark : exported.settings.remarks) fmt::print(stderr, "{}\n", remark);
  if (exported.settings.remarks.empty() && exported.words.empty())
    fmt::print(stderr, "No number changes.\n");
  fmt::print(stderr, "{}", exported.words);
  say_next(exported.next);
  return kDone;
}

/// Of a fit of belts, or of a diagnosis of them.
files::Maslow4Settings maslow4_settings_of(const InputFile& file) {
  require_kind(file, {FileKind::anchors, FileKind::diagnosis});
  if (file.kind == FileKind::anchors) return files::write_maslow4_settings(load_anchors(file).fit);
  const grid::diagnosis::Diagnosis found = load_diagnosis(file);
  if (found.drawing) refuse_drawing(file);
  if (!found.belts) {
    throw files::InputError(
        {{file.name,
          "/observations",
          "a diagnosis of a machine on chains",
          "one of four belts; of chains export groundcontrol has the numbers"}});
  }
  return files::write_maslow4_settings(found);
}

int export_maslow4(const ExportCommand& command) {
  const files::Maslow4Settings settings = maslow4_settings_of(open_input(command.input));
  write_output(command.output, settings.text);
  for (const std::string& remark : settings.remarks) fmt::print(stderr, "{}\n", remark);
  return kDone;
}

void add_maslow4(Verb verb, Run& run) {
  auto command = std::make_shared<ExportCommand>();
  Verb maslow4 = verb.add_verb("maslow4", "The lines to paste into a Maslow 4's terminal");
  add_input(maslow4,
            "file",
            command->input,
            "A chaintrue_anchors file, as fit makes it, or a diagnosis of belts")
      .required();
  add_output(maslow4,
             "-o,--output",
             command->output,
             {Origin::list},
             "Where they go; - is standard output")
      .shows_default();
  maslow4.footer(
      "The anchors as fitted, in the belts' own millimetres; with a taped distance the scales, "
      "where "
      "they change.\n\n"
      "Example:\n"
      "  build/chaintrue fit fixtures/belts/thirty_one_places.json -o anchors.json\n"
      "  build/chaintrue export maslow4 anchors.json");
  maslow4.when_chosen([command, &run] { run = [command] { return export_maslow4(*command); }; });
}

}  // namespace

void add_export(Verb app, Run& run) {
  Verb verb = app.add_verb("export", "Turn a machine into settings for other programs");
  verb.require_verb();
  constexpr const char* kExample =
      "Example:\n  build/chaintrue export groundcontrol fixtures/machines/groundcontrol.json";
  verb.footer(kExample);
  auto command = std::make_shared<ExportCommand>();
  Verb groundcontrol =
      verb.add_verb("groundcontrol", "The numbers to type into GroundControl's settings");
  add_input(groundcontrol,
            "file",
            command->input,
            "A chaintrue_machine file, a chaintrue_map, or a chaintrue_diagnosis")
      .required();
  add_output(groundcontrol,
             "-o,--output",
             command->output,
             {Origin::list},
             "Where they go; - is standard output")
      .shows_default();
  add_output(groundcontrol,
             "--map-after",
             command->map_after,
             {Origin::map},
             "Of a map: write the map that is right once these numbers are typed in");
  groundcontrol.footer(fmt::format(
      "From a machine, or the one that a diagnosis found: the numbers in which it differs from its "
      "controller. From a map: the numbers that bring the controller nearest to it, and how near. "
      "All others stay as they were. No number rests on a cause that is less than 90 % sure: the "
      "exit code is 1 then, and nothing is written.\n\nOnce the numbers are typed in, stop using "
      "the old map: it corrects again what the numbers have mended, and parts come out wrong. Use "
      "the map of --map-after: it is for the same machine with these numbers, and corrects what is "
      "left.\n\n{}\n  build/chaintrue fit fixtures/start/marks.csv --machine "
      "fixtures/machines/groundcontrol.json -o map.json\n  build/chaintrue export groundcontrol "
      "map.json -o settings.ini --map-after map.after.json",
      kExample));
  groundcontrol.when_chosen([command, groundcontrol, &run] {
    run = [command, groundcontrol] { return export_groundcontrol(groundcontrol, *command); };
  });
  add_maslow4(verb, run);
  add_export_plotter(verb, run);
  add_export_linuxcnc(verb, run);
  add_export_klipper(verb, run);
  add_export_straight(verb, run);
}

}  // namespace chaintrue::cli
