// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/input_file.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "grid/files/controller_settings.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/sha256.hpp"
#include "grid/map/map_check.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "tools/cli/talk.hpp"
#include "tools/gcode/firmware.hpp"

namespace chaintrue::cli {
namespace {

/// Kinds of controllers with the same settings.
enum class SettingsOf { maslow, wall_plotter, none };

SettingsOf settings_of(ControllerKind kind) {
  if (kind == ControllerKind::ideal) return SettingsOf::none;
  return kind == ControllerKind::fluidnc_wallplotter ? SettingsOf::wall_plotter
                                                     : SettingsOf::maslow;
}

/// The kind of controller that has `now`. \throws InputError if none does.
ControllerKind kind_with(const Machine& stated, const SettingsFile& now,
                         const ControllerKind* in_place) {
  const ControllerKind of_file = now.read.machine.controller.kind;
  if (settings_of(of_file) == SettingsOf::none) {
    refuse(now.name, "/controller", "a machine without a controller",
           "a controller's settings; if the controller uses the machine file itself, give it with "
           "--machine");
  }
  const ControllerKind of_map = in_place != nullptr ? *in_place : stated.controller.kind;
  if (settings_of(of_map) == SettingsOf::none && in_place == nullptr) return of_file;
  if (settings_of(of_map) == settings_of(of_file)) return of_map;
  refuse(now.name, fmt::format("settings of a {} controller", name_of(of_file)),
         in_place != nullptr
             ? fmt::format("those of a {}, as given by --controller", name_of(of_map))
             : fmt::format("those of a {}, which the map was measured with; if another controller "
                           "now runs the machine, name it with --controller",
                           name_of(of_map)));
}

void refuse_other_chain(const std::vector<files::SettingChange>& changes, const std::string& file) {
  const auto of_chain = of_the_chain(changes);
  if (of_chain.empty()) return;
  refuse(file, in_words(of_chain),
         "the values that the map was measured with, because they define the meaning of a chain "
         "length: restore them, or measure and fit again");
}

}  // namespace

std::string_view name_of(ControllerKind kind) { return gcode::firmware(kind).name; }

std::string after_name(const std::string& map) {
  return std::filesystem::path(map).replace_extension(".after.json").string();
}

SettingsFile read_settings_file(const std::string& path) {
  return parse_settings_file(path, read_whole_file(path));
}

SettingsFile parse_settings_file(const std::string& path, const std::string& text) {
  const std::string file = name_in_messages(path);
  const bool json = is_json(text) && text.find('{') < text.find('[');
  if (json && files::is_webcontrol(text, file)) return {file, files::parse_webcontrol(text, file)};
  if (json) return {file, files::parse_machine(text, file), true};
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".yaml" || ending == ".yml" || files::is_fluidnc(text))
    return {file, files::parse_fluidnc(text, file)};
  return {file, files::parse_groundcontrol(text, file)};
}

Machine with_settings(const Machine& stated, const SettingsFile& now,
                      const ControllerKind* in_place) {
  const Machine& file = now.read.machine;
  const bool names_none = settings_of(stated.controller.kind) == SettingsOf::none;
  Machine machine = stated;
  machine.controller.kind = kind_with(stated, now, in_place);
  machine.controller.settings = file.controller.settings;
  // A ring and brackets do not share a sled.
  if (file.attachment.index() != stated.attachment.index()) machine.attachment = file.attachment;
  if (settings_of(machine.controller.kind) != SettingsOf::maslow) {
    machine.motors = file.motors;
    machine.bed = file.bed;
  }
  if (names_none) {
    say("The map has no controller; a {} with the settings in {} is used.",
        name_of(machine.controller.kind), now.name);
    return machine;
  }
  Machine before = stated;
  before.controller.kind = machine.controller.kind;
  const auto changes =
      changed_settings(files::settings_in_force(before), files::settings_in_force(machine));
  refuse_other_chain(changes, now.name);
  if (changes.empty()) {
    say("{} has the map's settings.", now.name);
  } else {
    say("The settings in {} differ from those that the map was measured with ({}); the new ones "
        "are used.",
        now.name, in_words(changes));
  }
  return machine;
}

CompensationMap with_settings_of(const std::string& settings, const std::string& map_name,
                                 const CompensationMap& map, Measured& measured) {
  const auto stated = stated_machine(map);
  if (!stated) {
    refuse(map_name, "a map without a machine", "no --settings: its points are chain lengths");
  }
  const SettingsFile file = read_settings_file(settings);
  const model::Controller now = with_settings(*stated, file, nullptr).controller;
  if (now.kind == ControllerKind::fluidnc_wallplotter) {
    refuse(file.name, "anchors of a wall plotter",
           "the new points with the machine that executed the commands: give it with --machine");
  }
  measured = commanded_with(measured, now);
  return map_for_settings(map, now, "");
}

bool was_made_from(const std::string& made, const std::string& from) {
  const auto made_by = files::made_by_of(read_whole_file(made), made);
  const std::string hash = files::sha256(read_whole_file(from));
  return made_by && any_of(made_by->inputs, having(&SourceFile::sha256, hash));
}

std::optional<ControllerSettings> settings_before(const std::string& map) {
  namespace fs = std::filesystem;
  if (map == "-") return std::nullopt;
  const auto made_by = files::made_by_of(read_whole_file(map), map);
  if (!made_by || made_by->verb != "export groundcontrol" || made_by->inputs.empty())
    return std::nullopt;
  const std::string from = (fs::path(map).parent_path() / made_by->inputs.front().name).string();
  if (!fs::is_regular_file(from) || !was_made_from(map, from)) return std::nullopt;
  const CompensationMap exported = files::parse_map(read_whole_file(from), from);
  if (exported.machine() == nullptr) return std::nullopt;
  return exported.machine()->controller.settings;
}

std::optional<Check> with_typed_settings(const CompensationMap& map, const Measured& measured,
                                         const Check& found,
                                         std::optional<ControllerSettings> before) {
  if (found.is_valid_as_it_is() || map.machine() == nullptr) return std::nullopt;
  const auto differ_from_map = [&](const ControllerSettings& settings) {
    Machine in_force = *map.machine();
    in_force.controller.settings = settings;
    return changed_settings(files::settings_in_force(*map.machine()),
                            files::settings_in_force(in_force));
  };
  if (before && differ_from_map(*before).empty()) before.reset();
  std::optional<ControllerSettings> others = before;
  if (!before) {
    const auto typed = grid::settings_to_type(map);
    if (!typed || !typed->worth_typing) return std::nullopt;
    others = typed->settings;
  }
  auto changed = grid::changed_settings(map, measured, *others, found);
  if (!changed) return std::nullopt;
  const std::string differ = in_words(differ_from_map(changed->in_force));
  constexpr std::string_view kSentences[][3] = {
      {"Only some of the numbers from export groundcontrol have been typed in", "these",
       "Type in the others too, and use the map from export groundcontrol --map-after."},
      {"The settings have changed since this map was measured",
       "the numbers from export groundcontrol",
       "Use the map from export groundcontrol --map-after."},
      {"Only some of the numbers that this map is for are in the controller",
       "the others unchanged", "Type in the others too."},
      {"The numbers that this map is for are not in the controller", "the previous ones",
       "Type them in, or use the map that they were exported from."}};
  const auto& [what, with, to_do] = kSentences[(before ? 2 : 0) + (changed->all ? 1 : 0)];
  changed->check.sentence = fmt::format(
      "{}: the new points fit {} ({}) to {:.2f} mm rms in a chain, the map's settings to {:.2f} "
      "mm. {} {}",
      what, with, differ, changed->with_these_mm, changed->as_it_is_mm, to_do,
      changed->check.sentence);
  return std::move(changed->check);
}

}  // namespace chaintrue::cli
