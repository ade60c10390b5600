// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/typed_settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "grid/containers.hpp"
#include "grid/files/controller_settings.hpp"
#include "grid/files/input_error.hpp"
#include "grid/files/map_file.hpp"
#include "grid/files/sha256.hpp"
#include "grid/files/sources.hpp"
#include "grid/files/whole_file.hpp"
#include "grid/map/check_settings.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "tools/cli/settings_file.hpp"

namespace chaintrue::cli {

CompensationMap with_settings_of(const std::string& settings,
                                 const std::string& map_name,
                                 const CompensationMap& map,
                                 grid::Measured& measured) {
  const auto stated = grid::stated_machine(map);
  if (!stated) {
    throw InputError(
        {{map_name, "", "a map without a machine", "no --settings: its points are chain lengths"}});
  }
  const SettingsFile file = read_settings_file(settings);
  const model::Controller now = with_settings(*stated, file, nullptr).controller;
  if (now.kind == ControllerKind::fluidnc_wallplotter) {
    throw InputError(
        {{file.name,
          "",
          "anchors of a wall plotter",
          "the new points with the machine that executed the commands: give it with --machine"}});
  }
  measured = grid::commanded_with(measured, now);
  return grid::map_for_settings(map, now, "");
}

bool was_made_from(const std::string& made, const std::string& from) {
  const auto made_by = files::made_by_of(files::read_whole_file(made), made);
  files::Sha256 hash;
  hash.add(files::read_whole_file(from));
  return made_by && grid::any_of(made_by->inputs,
                                 [&](const auto& input) { return input.sha256 == hash.text(); });
}

std::optional<model::ControllerSettings> settings_before(const std::string& map) {
  namespace fs = std::filesystem;
  if (map == "-") return std::nullopt;
  const auto made_by = files::made_by_of(files::read_whole_file(map), map);
  if (!made_by || made_by->verb != "export groundcontrol" || made_by->inputs.empty())
    return std::nullopt;
  const std::string from = (fs::path(map).parent_path() / made_by->inputs.front().name).string();
  if (!fs::is_regular_file(from) || !was_made_from(map, from)) return std::nullopt;
  const CompensationMap exported = files::parse_map(files::read_whole_file(from), from);
  if (exported.machine() == nullptr) return std::nullopt;
  return exported.machine()->controller.settings;
}

std::optional<grid::Check> with_typed_settings(const CompensationMap& map,
                                               const grid::Measured& measured,
                                               const grid::Check& found,
                                               std::optional<model::ControllerSettings> before) {
  if (found.is_valid_as_it_is() || map.machine() == nullptr) return std::nullopt;
  const auto differ_from_map = [&](const model::ControllerSettings& settings) {
    Machine in_force = *map.machine();
    in_force.controller.settings = settings;
    return files::changed_settings(files::settings_in_force(*map.machine()),
                                   files::settings_in_force(in_force));
  };
  if (before && differ_from_map(*before).empty()) before.reset();
  std::optional<model::ControllerSettings> others = before;
  if (!before) {
    const auto typed = grid::settings_to_type(map);
    if (!typed || !typed->worth_typing) return std::nullopt;
    others = typed->settings;
  }
  auto changed = grid::changed_settings(map, measured, *others, found);
  if (!changed) return std::nullopt;
  const std::string differ = files::in_words(differ_from_map(changed->in_force));
  const auto sentence = [&](std::string_view what, std::string_view with, std::string_view to_do) {
    return fmt::format(
        "{}: the new points fit {} ({}) to {:.2f} mm rms in a chain, the map's settings to {:.2f} "
        "mm. {} {}",
        what,
        with,
        differ,
        changed->with_these_mm,
        changed->as_it_is_mm,
        to_do,
        changed->check.sentence);
  };
  std::string& said = changed->check.sentence;
  if (!before && changed->all) {
    said = sentence("The settings have changed since this map was measured",
                    "the numbers from export groundcontrol",
                    "Use the map from export groundcontrol --map-after.");
  } else if (!before) {
    said = sentence("Only some of the numbers from export groundcontrol have been typed in",
                    "these",
                    "Type in the others too, and use the map from export groundcontrol --map-after.");
  } else if (changed->all) {
    said = sentence("The numbers that this map is for are not in the controller",
                    "the previous ones",
                    "Type them in, or use the map that they were exported from.");
  } else {
    said = sentence("Only some of the numbers that this map is for are in the controller",
                    "the others unchanged",
                    "Type in the others too.");
  }
  return std::move(changed->check);
}

}  // namespace chaintrue::cli
