// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/settings_file.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "grid/files/controller_settings.hpp"
#include "grid/files/file_type.hpp"
#include "grid/files/fluidnc_file.hpp"
#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/webcontrol_file.hpp"
#include "grid/files/whole_file.hpp"
#include "tools/gcode/firmware.hpp"

namespace chaintrue::cli {
namespace {

/// Kinds of controllers with the same settings.
enum class SettingsOf { maslow, wall_plotter, none };

SettingsOf settings_of(ControllerKind kind) {
  switch (kind) {
    case ControllerKind::maslow_classic:
    case ControllerKind::holey:
      return SettingsOf::maslow;
    case ControllerKind::fluidnc_wallplotter:
      return SettingsOf::wall_plotter;
    case ControllerKind::ideal:
      break;
  }
  return SettingsOf::none;
}

/// The kind of controller that has `now`. \throws InputError if none does.
ControllerKind kind_with(const Machine& stated,
                         const SettingsFile& now,
                         const ControllerKind* in_place) {
  const ControllerKind of_file = now.read.machine.controller.kind;
  if (settings_of(of_file) == SettingsOf::none) {
    throw InputError({{now.name,
                       "/controller",
                       "a machine without a controller",
                       "a controller's settings; if the controller uses the machine file itself, "
                       "give it with --machine"}});
  }
  const ControllerKind of_map = in_place != nullptr ? *in_place : stated.controller.kind;
  if (settings_of(of_map) == SettingsOf::none && in_place == nullptr) return of_file;
  if (settings_of(of_map) == settings_of(of_file)) return of_map;
  throw InputError(
      {{now.name,
        "",
        fmt::format("settings of a {} controller", name_of(of_file)),
        in_place != nullptr
            ? fmt::format("those of a {}, as given by --controller", name_of(of_map))
            : fmt::format("those of a {}, which the map was measured with; if another controller "
                          "now runs the machine, name it with --controller",
                          name_of(of_map))}});
}

void refuse_other_chain(const std::vector<files::SettingChange>& changes, const std::string& file) {
  const auto of_chain = files::of_the_chain(changes);
  if (of_chain.empty()) return;
  throw InputError({{file,
                     "",
                     files::in_words(of_chain),
                     "the values that the map was measured with, because they define the meaning "
                     "of a chain length: restore them, or measure and fit again"}});
}

}  // namespace

std::string_view name_of(ControllerKind kind) { return gcode::firmware(kind).name; }

std::string after_name(const std::string& map) {
  return std::filesystem::path(map).replace_extension(".after.json").string();
}

SettingsFile read_settings_file(const std::string& path) {
  return parse_settings_file(path, files::read_whole_file(path));
}

SettingsFile parse_settings_file(const std::string& path, const std::string& text) {
  const std::string file = files::name_in_messages(path);
  const bool json = files::is_json(text) && text.find('{') < text.find('[');
  if (json && files::is_webcontrol(text, file)) return {file, files::parse_webcontrol(text, file)};
  if (json) return {file, files::parse_machine_with_warnings(text, file), true};
  const std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".yaml" || ending == ".yml" || files::is_fluidnc(text))
    return {file, files::parse_fluidnc(text, file)};
  return {file, files::parse_groundcontrol(text, file)};
}

Machine with_settings(const Machine& stated,
                      const SettingsFile& now,
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
    fmt::print(stderr,
               "The map has no controller; a {} with the settings in {} is used.\n",
               name_of(machine.controller.kind),
               now.name);
    return machine;
  }
  Machine before = stated;
  before.controller.kind = machine.controller.kind;
  const auto changes =
      files::changed_settings(files::settings_in_force(before), files::settings_in_force(machine));
  refuse_other_chain(changes, now.name);
  if (changes.empty()) {
    fmt::print(stderr, "{} has the map's settings.\n", now.name);
  } else {
    fmt::print(stderr,
               "The settings in {} differ from those that the map was measured with ({}); the new "
               "ones are used.\n",
               now.name,
               files::in_words(changes));
  }
  return machine;
}

}  // namespace chaintrue::cli
