// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue export: a machine, or its calibration, as numbers to type into another program.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "grid/containers.hpp"
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
#include "grid/plotter/settings_to_paste.hpp"
#include "model/effects/catalogue.hpp"
#include "tools/cli/anchors_document.hpp"
#include "tools/cli/diagnosis_words.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/made_by.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/settings_file.hpp"
#include "tools/cli/start_plotter.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

namespace {

struct ExportCommand {
  std::string input;
  std::string output = "-";
  /// The map that is valid once the numbers are typed in.
  std::string map_after;
};

/// The numbers, and the sentences about them.
struct Exported {
  files::GroundcontrolText settings;
  std::string words;
  std::vector<std::string> next;
  /// For a map: the map with a controller that has the numbers.
  std::optional<CompensationMap> map_after = std::nullopt;
  bool is_refused = false;  ///< the reason was printed
};

std::vector<std::string> settings_page(const std::string& path) {
  return {"report", path, "-o", page_alongside(path)};
}

/// The controller in force or, if it has no settings, one with the machine's dimensions.
model::Controller controller_of(const Machine& machine) {
  if (machine.controller.settings.motor_spacing_mm) return machine.controller;
  const bool is_holey = machine.controller.kind == ControllerKind::holey;
  return {is_holey ? ControllerKind::holey : ControllerKind::maslow_classic,
          files::measures_as_settings(machine)};
}

/// Next steps: type in, check with the map after, cut with it.
std::vector<std::string> next_of(const ExportCommand& command, bool is_worth_typing) {
  const std::string& map = command.input;
  if (!is_worth_typing) return settings_page(map);
  if (!command.map_after.empty()) return {"plan", "--check", command.map_after, "-o", "check.csv"};
  return {"export", "groundcontrol", map, "-o", "settings.ini", "--map-after", after_name(map)};
}

/// Causes without a setting in the firmware, with their contribution to the error.
std::string words_of(const grid::Lacking& lacking, const Machine& machine) {
  if (lacking.what == "top_beam_tilt") {
    return fmt::format(
        "GroundControl's own firmware has no setting for the tilt of the beam, which causes {:.2f} "
        "mm of that: level the beam. The holey firmware has topbeamtilt; if you use it, set "
        "\"kind\": \"holey\" in the machine's /controller.\n",
        lacking.costs_mm);
  }
  if (lacking.what == "chain_stretch") {
    return fmt::format(
        "GroundControl's own firmware has no setting for the stretch of the chains, which causes "
        "{:.2f} mm of that.\n",
        lacking.costs_mm);
  }
  const model::effects::Effect* effect = model::effects::find_effect(machine, lacking.what);
  return fmt::format("No firmware has a setting for this: {}. It causes {:.2f} mm of that{}.\n",
                     effect != nullptr ? effect->cause : std::string_view(lacking.what),
                     lacking.costs_mm,
                     effect != nullptr ? fmt::format("; {}", effect->remedy) : "");
}

/// Errors before and after, from one evaluation, and the causes of the rest.
std::string words_of(const std::string& today,
                     const Machine& machine,
                     const grid::SettingsToType& typed,
                     bool holds_numbers) {
  std::string words =
      typed.worth_typing || !holds_numbers
          ? fmt::format("{} with these numbers {:.2f} and {:.2f} mm.\n",
                        today,
                        typed.typed.rms_mm,
                        typed.typed.maximum_mm)
          : fmt::format("{} Other numbers would gain less than a tenth, so keep yours.\n", today);
  for (const grid::Lacking& one : typed.lacking) words += words_of(one, machine);
  return words;
}

/// For a map the error today is the same as in every verb; the placement of a hand-laid sheet does
/// not depend on the numbers.
std::string today_in_words(const CompensationMap& map, const grid::SettingsToType& typed) {
  const grid::ErrorSummary today = grid::error_in_use(map).value_or(typed.as_it_is);
  return fmt::format(
      "With today's settings the tool is {:.2f} mm rms off over the measured part, {:.2f} mm at "
      "worst{};",
      today.rms_mm,
      today.maximum_mm,
      has_placed_sheet(map.contents())
          ? fmt::format(" ({:.2f} and {:.2f} mm with the sheet correctly placed)",
                        typed.as_it_is.rms_mm,
                        typed.as_it_is.maximum_mm)
          : "");
}

/// The map after its numbers are typed in.
std::string map_after_in_words(const ExportCommand& command) {
  if (command.map_after.empty())
    return "The rest is corrected by gcode compensate with the map. Once the numbers are typed in, "
           "this map is out of date; --map-after writes the one to use then.\n";
  return fmt::format(
      "Type them in, measure five marks and check them with {0}. From then on run programs "
      "unchanged or, for better accuracy, compensate them with {0}. Do not use {1} again.\n",
      command.map_after,
      command.input);
}

/// Old values are given for numbers in force.
files::GroundcontrolText text_of(const Machine& machine,
                                 const grid::SettingsToType& typed,
                                 const std::string& by,
                                 bool holds_numbers) {
  auto text = files::write_groundcontrol_settings(machine, typed.settings, by);
  if (!holds_numbers) text.remarks.clear();
  return text;
}

/// The map of the machine with its numbers typed in.
CompensationMap map_after_of(const CompensationMap& map,
                             const Machine& before,
                             const model::Controller& now,
                             bool holds_numbers) {
  std::string numbers;
  if (holds_numbers) {
    Machine after = before;
    after.controller = now;
    numbers = fmt::format(" ({})",
                          files::in_words(files::changed_settings(
                              files::settings_in_force(before), files::settings_in_force(after))));
  }
  return grid::map_for_settings(
      map,
      now,
      fmt::format("For a controller that holds the numbers from export groundcontrol{}.", numbers));
}

/// The best fit of the controller's formulas to the map.
Exported of_map(const CompensationMap& map, const std::string& file, const ExportCommand& command) {
  const auto fail = [&file](const grid::SettingsFailure& why) {
    throw InputError({{file, "", "", "", why.sentence()}});
  };
  if (map.machine() == nullptr) fail(grid::settings_to_type(map).error());
  Machine machine = *map.machine();
  const bool holds_numbers = machine.controller.settings.motor_spacing_mm.has_value();
  const bool is_wall_plotter = machine.controller.kind == ControllerKind::fluidnc_wallplotter;
  machine.controller = controller_of(machine);
  const auto typed = grid::settings_to_type(map, machine.controller);
  Exported result;
  if (typed) {
    result = {text_of(machine,
                      *typed,
                      fmt::format("the {} points of {}", typed->points, file),
                      holds_numbers),
              words_of(today_in_words(map, *typed), machine, *typed, holds_numbers),
              next_of(command, (typed->worth_typing || !holds_numbers) && !is_wall_plotter),
              map};
    if (!typed->worth_typing && holds_numbers) return result;
    if (typed->worth_typing) result.words += map_after_in_words(command);
  } else {
    // If none can be found, the machine's own dimensions are the settings.
    if (holds_numbers) fail(typed.error());
    result = {files::write_groundcontrol(*map.machine()), "", settings_page(command.input)};
  }
  model::Controller now = machine.controller;
  if (typed) now.settings = typed->settings;
  result.map_after.reset();
  if (!is_wall_plotter) result.map_after = map_after_of(map, machine, now, holds_numbers);
  return result;
}

/// The corners of the bed.
std::vector<BedPoint> corners_of(const Bed& bed) {
  const double x = 0.5 * bed.width_mm, y = 0.5 * bed.height_mm;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

/// A machine that agrees with its controller's settings changes none of them.
Exported of_machine(const Machine& stated,
                    const std::string& file,
                    const std::vector<BedPoint>& area,
                    std::vector<std::string> next) {
  const bool holds_numbers = stated.controller.settings.motor_spacing_mm.has_value();
  if (!files::says_more_than_its_settings(stated))
    return {files::write_groundcontrol(stated), "", std::move(next)};
  Machine machine = stated;
  machine.controller = controller_of(stated);
  const auto typed = grid::settings_to_type(machine, area);
  // If none can be found, the machine's own dimensions are the settings.
  if (!typed) return {files::write_groundcontrol(stated), "", std::move(next)};
  const std::string today = fmt::format(
      "If the machine were as {} describes it, the tool would be {:.2f} mm rms off with {}, {:.2f} "
      "mm at worst;",
      file,
      typed->as_it_is.rms_mm,
      holds_numbers ? "today's settings" : "its own dimensions as settings",
      typed->as_it_is.maximum_mm);
  return {text_of(machine, *typed, file, holds_numbers),
          words_of(today, machine, *typed, holds_numbers),
          std::move(next)};
}

/// True, with a message, if numbers would depend on an effect that a diagnosis added and that may
/// not act.
bool refuses_weak_causes(const std::vector<AppliedEffect>& effects, const std::string& name) {
  std::vector<std::string> weak;
  for (const AppliedEffect& one : effects) {
    if (one.probability.value_or(1.0) >= diagnosis::kSureOfCause) continue;
    const model::effects::Effect* effect = model::effects::find_effect(one.effect);
    weak.push_back(fmt::format("{}{}{} ({})",
                               effect != nullptr ? effect->cause : std::string_view(one.effect),
                               one.side.empty() ? "" : ", ",
                               one.side,
                               diagnosis::percent(*one.probability)));
  }
  if (weak.empty()) return false;
  say("{}: this machine depends on {}, and numbers to type in require at least {}. Measure what "
      "the diagnosis proposes next and diagnose again; --force continues anyway.",
      name,
      diagnosis::joined(weak, "and"),
      diagnosis::percent(diagnosis::kSureOfCause));
  return true;
}

/// Named causes that may be the paper's are not in the machine.
std::string left_out_in_words(const Diagnosis& found) {
  std::string words;
  const auto is_of_paper = [](const auto& same) {
    return same.cause.effect->station == model::effects::Station::paper;
  };
  for (const diagnosis::Cause& cause : causes_left_out(found)) {
    if (grid::none_of(cause.same_as, is_of_paper)) continue;
    words += fmt::format(
        "These numbers leave out an error that may be {}{} or the tape used for the marks. A map "
        "corrects it either way: export its numbers instead.\n",
        cause.cause.effect->cause,
        diagnosis::side_words(cause.cause));
  }
  return words;
}

/// The area of the marks or holes, or the whole bed.
std::vector<BedPoint> area_of(const Diagnosis& found) {
  std::vector<BedPoint> area;
  for (const auto& point : found.points) area.push_back({point.mark.x_mm, point.mark.y_mm});
  for (const auto& hole : found.holes) area.push_back({hole.mark.x_mm, hole.mark.y_mm});
  constexpr std::size_t kFewest = 3;
  return area.size() < kFewest ? corners_of(found.extended_machine.bed) : area;
}

Exported of_diagnosis(const InputFile& file, const Diagnosis& found) {
  Exported exported =
      of_machine(found.extended_machine, file.name, area_of(found), settings_page(file.path));
  exported.words += left_out_in_words(found);
  return exported;
}

Exported of_machine_file(const InputFile& file, bool forced, std::vector<std::string> next) {
  const Machine machine = load_machine(file);
  if (!forced && refuses_weak_causes(machine.effects, file.name))
    return Exported{{}, "", {}, std::nullopt, true};
  return of_machine(machine, file.name, corners_of(machine.bed), std::move(next));
}

/// JSON without a type: probably a machine, whose reader reports what is missing.
bool is_untyped_json(const InputFile& file) {
  return file.kind == FileKind::other && files::is_json(file.text) &&
         files::file_type_of(file.text, file.name).empty();
}

[[noreturn]] void refuse_drawing(const InputFile& file) {
  refuse(file.name,
         "/observations",
         "a diagnosis of a test drawing",
         "one of another machine; for a V-plotter, export plotter prints the lines from the result "
         "of fit");
}

Exported export_of(const InputFile& file, const ExportCommand& command, bool forced) {
  if (is_untyped_json(file)) return of_machine_file(file, forced, {});
  require_kind(
      file,
      {FileKind::machine, FileKind::map, FileKind::diagnosis},
      file.kind == FileKind::anchors ? "anchors of four belts are read by export maslow4" : "");
  if (file.kind == FileKind::map) {
    const CompensationMap map = load_map(file);
    if (!forced && refuses_to_cut_with(map)) return Exported{{}, "", {}, std::nullopt, true};
    return of_map(map, file.name, command);
  }
  if (file.kind == FileKind::diagnosis) {
    const Diagnosis found = load_diagnosis(file);
    if (found.drawing) refuse_drawing(file);
    if (found.belts) {
      refuse(file.name,
             "/observations",
             "a diagnosis of four belts",
             "one of a machine on chains; for belts use export maslow4");
    }
    std::vector<AppliedEffect> taken = found.extended_machine.effects;
    grid::append_all(taken, found.data_corrections);
    if (!forced && refuses_weak_causes(taken, file.name))
      return Exported{{}, "", {}, std::nullopt, true};
    return of_diagnosis(file, found);
  }
  return of_machine_file(file, forced, {"plan", "--machine", file.path, "-o", "marks.csv"});
}

Facts facts_of(const InputFile& file) {
  if (file.kind == FileKind::map) return facts::map;
  return file.kind == FileKind::diagnosis ? facts::diagnosis : facts::machine;
}

/// \throws InputError if there is no such map.
std::string written_map_after(Verb verb, const Exported& exported, const ExportCommand& command) {
  if (command.map_after.empty()) return "";
  if (exported.map_after) return files::write_map(*exported.map_after, made_by(verb));
  refuse(command.input,
         "a map for a controller without GroundControl's settings",
         "--map-after to be left out: put the machine's anchors into FluidNC's "
         "config.yaml, and compensate with this map and --settings config.yaml");
}

int export_groundcontrol(Verb verb, const ExportCommand& command) {
  const InputFile file = open_input(command.input);
  const Exported exported = export_of(file, command, verb.is_given("--force"));
  verb.refuse_idle_options(facts_of(file));
  if (exported.is_refused) return kCheckFailed;
  write_outputs({{command.map_after, written_map_after(verb, exported, command)},
                 {command.output, exported.settings.text}});
  for (const std::string& remark : exported.settings.remarks) say("{}", remark);
  if (exported.settings.remarks.empty() && exported.words.empty()) say("No number changes.");
  fmt::print(stderr, "{}", exported.words);
  say_next(exported.next);
  return kDone;
}

/// From a fit or a diagnosis of belts; empty, with a message, if the anchors are too uncertain.
std::optional<files::Maslow4Settings> maslow4_settings_of(const InputFile& file, bool forced) {
  require_kind(file, {FileKind::anchors, FileKind::diagnosis});
  if (file.kind == FileKind::anchors) {
    const files::FittedAnchors found = load_anchors(file);
    const std::string why = not_to_paste(
        found.fit, grid::error_of_belts(found.fit, found.holes ? &*found.holes : nullptr));
    if (forced || why.empty()) return files::write_maslow4_settings(found.fit);
    say("{} --force continues anyway.", why);
    return std::nullopt;
  }
  const Diagnosis found = load_diagnosis(file);
  if (found.drawing) refuse_drawing(file);
  if (!found.belts) {
    refuse(file.name,
           "/observations",
           "a diagnosis of a machine on chains",
           "one of four belts; for chains use export groundcontrol");
  }
  return files::write_maslow4_settings(found);
}

int export_maslow4(Verb verb, const ExportCommand& command) {
  const auto settings = maslow4_settings_of(open_input(command.input), verb.is_given("--force"));
  if (!settings) return kCheckFailed;
  write_output(command.output, settings->text);
  for (const std::string& remark : settings->remarks) say("{}", remark);
  say("These lines are lost when the machine is switched off, unless $CD=/maslow.yaml saves them.");
  return kDone;
}

void add_maslow4(Verb verb) {
  auto command = std::make_shared<ExportCommand>();
  Verb maslow4 = verb.add_verb("maslow4", "Print the lines to paste into a Maslow 4's terminal");
  add_input(
      maslow4, "file", command->input, "A chaintrue_anchors file from fit, or a diagnosis of belts")
      .required();
  add_output(
      maslow4, "-o,--output", command->output, {Origin::list}, "Output file; - is standard output")
      .shows_default();
  maslow4.footer(
      "The fitted anchors, in millimetres of belt; with a taped distance also the scales, if they "
      "change.\n\nExample:\n  build/chaintrue fit fixtures/belts/thirty_one_places.json -o "
      "anchors.json\n  build/chaintrue export maslow4 anchors.json");
  maslow4.runs(command, export_maslow4);
}

}  // namespace

void add_export(Verb app) {
  Verb verb = app.add_verb("export",
                           "Convert a map, machine or diagnosis into settings for other programs");
  verb.require_verb();
  constexpr const char* kExample =
      "Example:\n  build/chaintrue export groundcontrol fixtures/machines/groundcontrol.json";
  verb.footer(kExample);
  auto command = std::make_shared<ExportCommand>();
  Verb groundcontrol =
      verb.add_verb("groundcontrol", "Print the numbers to type into GroundControl");
  add_input(groundcontrol,
            "file",
            command->input,
            "A chaintrue_machine file, a chaintrue_map, or a chaintrue_diagnosis")
      .required();
  add_output(groundcontrol,
             "-o,--output",
             command->output,
             {Origin::list},
             "Output file; - is standard output")
      .shows_default();
  add_output(groundcontrol,
             "--map-after",
             command->map_after,
             {Origin::map},
             "With a map: also write the map to use once these numbers are typed in")
      .acts_on(facts::map,
               "to be left out, because only a map has a successor for the new numbers");
  groundcontrol.footer(fmt::format(
      "Prints the settings that bring the controller closest to the map, to the machine, or to the "
      "machine that a\ndiagnosis found, the error before and after, and the error from causes "
      "without a setting. Other settings\nare unchanged. No number is based on a cause below 90 %: "
      "then the exit code is 1 and nothing is written.\n\nOnce the numbers are typed in, do not "
      "use the old map: it would correct the same error again. Use the map\nfrom --map-after, "
      "which is for the same machine with these numbers and corrects the remaining error.\n\n{}\n  "
      "build/chaintrue fit fixtures/start/marks.csv --machine fixtures/machines/groundcontrol.json "
      "-o map.json\n  build/chaintrue export groundcontrol map.json -o settings.ini --map-after "
      "map.after.json",
      kExample));
  groundcontrol.runs(command, export_groundcontrol);
  add_maslow4(verb);
  add_export_plotter(verb);
  add_export_map(verb);
}

namespace {

struct ExportPlotterCommand {
  std::string input;
  std::string output = "-";
};

int export_plotter(const ExportPlotterCommand& command) {
  const InputFile file = open_input(command.input);
  require_kind(file, {FileKind::plotter});
  const grid::KnownPlotter plotter = load_plotter(file).plotter;
  if (!plotter.found) {
    refuse(file.name,
           "/found",
           "",
           "results of a test drawing; chaintrue fit drawing.json -o found.json writes a plotter "
           "with them");
  }
  std::string text;
  for (const std::string& line :
       grid::settings_to_paste(plotter.set, grid::machine_found(plotter.set, *plotter.found)))
    text += line + "\n";
  write_output(command.output, text);
  say_next({"start", file.path, "second-drawing"});
  return kDone;
}

}  // namespace

void add_export_plotter(Verb export_verb) {
  auto command = std::make_shared<ExportPlotterCommand>();
  Verb verb = export_verb.add_verb(
      "plotter", "Print the numbers to type into a V-plotter's controller after a test drawing");
  add_input(verb, "file", command->input, "A chaintrue_plotter file that fit wrote from a drawing")
      .required();
  add_output(
      verb, "-o,--output", command->output, {Origin::list}, "Output file; - is standard output")
      .shows_default();
  verb.footer(
      "Example:\n"
      "  build/chaintrue fit fixtures/plotter/mural_drawing.json -o found.json\n"
      "  build/chaintrue export plotter found.json");
  verb.runs(command, export_plotter);
}

}  // namespace chaintrue::cli
