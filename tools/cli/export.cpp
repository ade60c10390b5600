// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue export: a machine, or its calibration, as numbers to type into another program.
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "grid/diagnosis/causes_fit.hpp"
#include "grid/diagnosis/workshop_units.hpp"
#include "grid/files/map_file.hpp"
#include "grid/plotter/settings_to_paste.hpp"
#include "model/effects/catalogue.hpp"
#include "tools/cli/export_numbers.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

namespace {

/// \throws Failed, unless forced, if numbers would depend on an effect that a diagnosis added and that
/// may not act.
void require_sure_causes(const std::vector<AppliedEffect>& effects, const std::string& name,
                         bool is_forced) {
  Words weak;
  for (const AppliedEffect& one : effects) {
    if (is_forced || one.probability.value_or(1.0) >= diagnosis::kSureOfCause) continue;
    const Effect* effect = effects::find_effect(one.effect);
    weak.push_back(
        fmt::format("{}{}{} ({})", effect != nullptr ? effect->cause : std::string_view(one.effect),
                    one.side.empty() ? "" : ", ", one.side, diagnosis::percent(*one.probability)));
  }
  if (weak.empty()) return;
  throw Failed(
      name, "weak_causes",
      fmt::format("this machine depends on {}, and numbers to type in require at least {}. Measure "
                  "what the diagnosis proposes next and diagnose again; --force continues anyway.",
                  diagnosis::joined(weak, "and"), diagnosis::percent(diagnosis::kSureOfCause)),
      kCheckFailed);
}

/// One of four belts, or of a machine on chains. \throws InputError for another.
Diagnosis load_diagnosis(const InputFile& file, bool of_belts) {
  Diagnosis found = load_diagnosis(file);
  if (found.drawing) {
    refuse(file.name, "/observations", "a diagnosis of a test drawing",
           "one of another machine; for a V-plotter, export plotter prints the lines from the "
           "result of fit");
  }
  if (found.belts.has_value() != of_belts) {
    refuse(file.name, "/observations",
           of_belts ? "a diagnosis of a machine on chains" : "a diagnosis of four belts",
           of_belts ? "one of four belts; for chains use export groundcontrol"
                    : "one of a machine on chains; for belts use export maslow4");
  }
  return found;
}

/// JSON without a type: probably a machine, whose reader reports what is missing.
bool is_untyped_json(const InputFile& file) {
  return file.kind == FileKind::other && is_json(file.text) &&
         files::file_type_of(file.text, file.name).empty();
}

Exported export_of(const InputFile& file, const ExportCommand& command, bool is_forced) {
  if (file.kind == FileKind::map) {
    const CompensationMap map = load_map(file);
    require_fit_for_cutting(not_to_cut_with(map), is_forced);
    return exported_from(map, file.name, command);
  }
  if (file.kind == FileKind::diagnosis) {
    const Diagnosis found = load_diagnosis(file, false);
    std::vector<AppliedEffect> taken = found.extended_machine.effects;
    append_all(taken, found.data_corrections);
    require_sure_causes(taken, file.name, is_forced);
    return exported_from(found, file.name, command);
  }
  const Machine machine = load_machine(file);
  require_sure_causes(machine.effects, file.name, is_forced);
  Words next;
  if (file.kind == FileKind::machine) next = {"plan", "--machine", file.path, "-o", "marks.csv"};
  return exported_from(machine, file.name, std::move(next));
}

/// \throws InputError if there is no such map.
std::string written_map_after(Verb verb, const Exported& exported, const ExportCommand& command) {
  if (command.map_after.empty()) return "";
  if (exported.map_after) return files::write_map(*exported.map_after, made_by(verb));
  refuse(command.input, "a map for a controller without GroundControl's settings",
         "--map-after to be left out: put the machine's anchors into FluidNC's "
         "config.yaml, and compensate with this map and --settings config.yaml");
}

int export_groundcontrol(Verb verb, const ExportCommand& command) {
  const InputFile file = open_input(command.input);
  if (!is_untyped_json(file)) {
    require_kind(
        file, {FileKind::machine, FileKind::map, FileKind::diagnosis},
        file.kind == FileKind::anchors ? "anchors of four belts are read by export maslow4" : "");
  }
  verb.refuse_idle_options(file.fact());
  const Exported exported = export_of(file, command, verb.is_given("--force"));
  write_outputs({{command.map_after, written_map_after(verb, exported, command)},
                 {command.output, exported.settings.text}});
  for (const std::string& remark : exported.settings.remarks) say("{}", remark);
  if (exported.settings.remarks.empty() && exported.words.empty()) say("No number changes.");
  say_lines(exported.words);
  say_next(exported.next);
  return kDone;
}

/// From a fit or a diagnosis of belts. \throws Failed if the anchors are too uncertain.
files::Maslow4Settings maslow4_settings_of(const InputFile& file, bool is_forced) {
  require_kind(file, {FileKind::anchors, FileKind::diagnosis});
  if (file.kind == FileKind::diagnosis)
    return files::write_maslow4_settings(load_diagnosis(file, true));
  const FittedAnchors found = load_anchors(file);
  require_fit_for_cutting(not_to_paste(found.fit, error_of_belts(found.fit, holes_of(found))),
                          is_forced);
  return files::write_maslow4_settings(found.fit);
}

int export_maslow4(Verb verb, const ExportCommand& command) {
  const auto settings = maslow4_settings_of(open_input(command.input), verb.is_given("--force"));
  write_output(command.output, settings.text);
  for (const std::string& remark : settings.remarks) say("{}", remark);
  say("These lines are lost when the machine is switched off, unless $CD=/maslow.yaml saves them.");
  return kDone;
}

/// \param what the files that are exported
void has_files(Verb verb, ExportCommand& command, const char* what) {
  verb.has({{"file", required(reads(command.input)), what},
            {"-o,--output", writes(command.output, {Origin::list}),
             "Output file; - is standard output"}});
}

void add_maslow4(Verb verb) {
  auto [maslow4, c] = verb.add_verb<ExportCommand>(
      "maslow4", "Print the lines to paste into a Maslow 4's terminal",
      R"(The fitted anchors, in millimetres of belt; with a taped distance also the scales, if they change.

Example:
  build/chaintrue fit fixtures/belts/thirty_one_places.json -o anchors.json
  build/chaintrue export maslow4 anchors.json)",
      export_maslow4);
  has_files(maslow4, c, "A chaintrue_anchors file from fit, or a diagnosis of belts");
}

int export_plotter(const ExportCommand& command) {
  const InputFile file = open_input(command.input);
  require_kind(file, {FileKind::plotter});
  const KnownPlotter plotter = load_found_plotter(file);
  std::string text;
  for (const std::string& line :
       settings_to_paste(plotter.set, machine_found(plotter.set, *plotter.found)))
    text += line + "\n";
  write_output(command.output, text);
  say_next({"start", file.path, "second-drawing"});
  return kDone;
}

void add_plotter(Verb export_verb) {
  auto [verb, c] = export_verb.add_verb<ExportCommand>(
      "plotter", "Print the numbers to type into a V-plotter's controller after a test drawing",
      R"(Example:
  build/chaintrue fit fixtures/plotter/mural_drawing.json -o found.json
  build/chaintrue export plotter found.json)",
      export_plotter);
  has_files(verb, c, "A chaintrue_plotter file that fit wrote from a drawing");
}

}  // namespace

void add_export(Verb app) {
  Verb verb =
      app.add_verb("export", "Convert a map, machine or diagnosis into settings for other programs",
                   R"(Example:
  build/chaintrue export groundcontrol fixtures/machines/groundcontrol.json)");
  verb.require_verb();
  auto [groundcontrol, c] = verb.add_verb<ExportCommand>(
      "groundcontrol", "Print the numbers to type into GroundControl",
      R"(Prints the settings that bring the controller closest to the map, to the machine, or to the machine that a
diagnosis found, the error before and after, and the error from causes without a setting. Other settings
are unchanged. No number is based on a cause below 90 %: then the exit code is 1 and nothing is written.

Once the numbers are typed in, do not use the old map: it would correct the same error again. Use the map
from --map-after, which is for the same machine with these numbers and corrects the remaining error.

Example:
  build/chaintrue export groundcontrol fixtures/machines/groundcontrol.json
  build/chaintrue fit fixtures/start/marks.csv --machine fixtures/machines/groundcontrol.json -o map.json
  build/chaintrue export groundcontrol map.json -o settings.ini --map-after map.after.json)",
      export_groundcontrol);
  has_files(groundcontrol, c,
            "A chaintrue_machine file, a chaintrue_map, or a chaintrue_diagnosis");
  groundcontrol.has(
      {{"--map-after", writes(c.map_after, {Origin::map}),
        "With a map: also write the map to use once these numbers are typed in", facts::map,
        "to be left out, because only a map has a successor for the new numbers"}});
  add_maslow4(verb);
  add_plotter(verb);
  add_export_map(verb);
}

}  // namespace chaintrue::cli
