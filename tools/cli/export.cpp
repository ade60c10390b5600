// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue export: a machine, or what was measured of it, as the numbers that another program
/// wants typed in.
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grid/files/anchors_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/settings_to_type.hpp"
#include "tools/cli/input_file.hpp"
#include "tools/cli/map_words.hpp"
#include "tools/cli/places.hpp"
#include "tools/cli/talk.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {
namespace {

namespace files = grid::files;

struct ExportCommand {
  std::string input;
  std::string output = "-";
};

/// The numbers, and what is said beside them.
struct Exported {
  files::GroundcontrolText settings;
  std::string words;
  std::vector<std::string> next;
  bool is_refused = false;  ///< the map is not to be cut with, which was said
};

/// What the machine says otherwise than its controller.
Exported of_machine(const model::Machine& machine, std::vector<std::string> next) {
  return {files::write_groundcontrol(machine), "", std::move(next)};
}

std::vector<std::string> settings_page(const std::string& path) {
  return {"report", path, "-o", std::filesystem::path(path).replace_extension(".html").string()};
}

/// What the controller's formulas can make of the map.
Exported of_map(const grid::CompensationMap& map,
                const std::string& file,
                const std::string& path) {
  const model::Machine* machine = map.machine();
  if (machine != nullptr && !machine->controller.settings.motor_spacing_mm) {
    return of_machine(*machine, settings_page(path));
  }
  const auto typed = grid::settings_to_type(map);
  if (!typed) throw files::InputError({{file, "", "this map", typed.error().sentence}});
  Exported result{
      files::write_groundcontrol_settings(
          *machine, typed->settings, fmt::format("the {} points of {}", typed->points, file)),
      "",
      typed->worth_typing ? std::vector<std::string>{"plan", "--check", path, "-o", "check.csv"}
                          : settings_page(path)};
  result.words =
      typed->worth_typing
          ? fmt::format(
                "With the settings in force the tool is {:.2f} mm rms off over the measured part, "
                "{:.2f} mm at worst; with these numbers {:.2f} and {:.2f} mm. What no number can "
                "mend, gcode compensate does with the map.\n"
                "Measure a few points again once they are typed in: this map is of the settings "
                "before.\n",
                typed->as_it_is.rms_mm,
                typed->as_it_is.maximum_mm,
                typed->typed.rms_mm,
                typed->typed.maximum_mm)
          : fmt::format(
                "With the settings in force the tool is {:.2f} mm rms off over the measured part; "
                "other numbers would not bring that down by a tenth, so none changes.\n",
                typed->as_it_is.rms_mm);
  return result;
}

/// JSON that does not say what it is: somebody's machine, whose reader says what is missing.
bool is_untyped_json(const InputFile& file) {
  return file.kind == FileKind::other && files::is_json(file.text) &&
         files::file_type_of(file.text, file.name).empty();
}

Exported export_of(const InputFile& file, bool forced) {
  if (is_untyped_json(file)) return of_machine(load_machine(file), {});
  require_kind(file,
               {FileKind::machine, FileKind::map, FileKind::diagnosis},
               file.kind == FileKind::anchors ? "anchors of four belts are taken by export maslow4"
                                              : "");
  if (file.kind == FileKind::map) {
    return with_map(file, [&](const grid::CompensationMap& map) {
      if (!forced && refuses_to_cut_with(map)) return Exported{{}, "", {}, true};
      return of_map(map, file.name, file.path);
    });
  }
  if (file.kind == FileKind::diagnosis) {
    const grid::diagnosis::Diagnosis found = load_diagnosis(file);
    if (found.belts) {
      throw files::InputError(
          {{file.name,
            "/observations",
            "a diagnosis of four belts",
            "one of a machine on chains; of belts export maslow4 has the lines"}});
    }
    return of_machine(found.extended_machine, settings_page(file.path));
  }
  return of_machine(load_machine(file), {"plan", "--machine", file.path, "-o", "marks.csv"});
}

int export_groundcontrol(const ExportCommand& command, bool forced) {
  const Exported exported = export_of(open_input(command.input), forced);
  if (exported.is_refused) return kCheckFailed;
  write_output(command.output, exported.settings.text);
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
  if (file.kind == FileKind::anchors)
    return files::write_maslow4_settings(load_anchors(file).fit);
  const grid::diagnosis::Diagnosis found = load_diagnosis(file);
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
  groundcontrol.footer(fmt::format(
      "Of a machine, or of the one that a diagnosis has found, the numbers that it says "
      "otherwise than its controller. Of a map the numbers with which the controller "
      "as it is comes nearest to it, and how near. All others come back as they "
      "came.\n\n{}",
      kExample));
  groundcontrol.when_chosen(
      [command, groundcontrol, &run] {
        run = [command, groundcontrol] {
          return export_groundcontrol(*command, groundcontrol.is_given("--force"));
        };
      });
  add_maslow4(verb, run);
}

}  // namespace chaintrue::cli
