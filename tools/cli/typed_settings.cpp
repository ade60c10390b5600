// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/cli/typed_settings.hpp"

#include <fmt/format.h>

#include <utility>

#include "grid/files/controller_settings.hpp"
#include "grid/files/input_error.hpp"
#include "grid/map/check_settings.hpp"
#include "grid/map/map_for_settings.hpp"
#include "grid/map/settings_to_type.hpp"
#include "tools/cli/settings_file.hpp"

namespace chaintrue::cli {

grid::CompensationMap with_settings_of(const std::string& settings,
                                       const std::string& map_name,
                                       const grid::CompensationMap& map,
                                       grid::Measured& measured) {
  const auto stated = grid::stated_machine(map);
  if (!stated) {
    throw grid::files::InputError({{map_name,
                                    "",
                                    "a map that knows no machine",
                                    "no --settings: its points are chain lengths"}});
  }
  const SettingsFile file = read_settings_file(settings);
  const model::Controller now = with_settings(*stated, file, nullptr).controller;
  if (now.kind == model::ControllerKind::fluidnc_wallplotter) {
    throw grid::files::InputError({{file.name,
                                    "",
                                    "anchors of a wall plotter",
                                    "the new points with the machine that they were commanded on: "
                                    "--machine takes it"}});
  }
  measured = grid::commanded_with(measured, now);
  return grid::map_for_settings(map, now, "");
}

std::optional<grid::Check> with_typed_settings(const grid::CompensationMap& map,
                                               const grid::Measured& measured,
                                               const grid::Check& found) {
  if (found.is_valid_as_it_is()) return std::nullopt;
  const auto typed = grid::settings_to_type(map);
  if (!typed || !typed->worth_typing) return std::nullopt;
  model::Machine after = *map.machine();
  after.controller.settings = typed->settings;
  auto changed = grid::changed_settings(map, measured, after.controller, found);
  if (!changed) return std::nullopt;
  namespace files = grid::files;
  changed->check.sentence = fmt::format(
      "The settings have changed since this map was measured: the new points fit the numbers of "
      "export groundcontrol ({}) within {:.2f} mm rms in a chain, the map's own within {:.2f} mm. "
      "Use the map of export groundcontrol --map-after. {}",
      files::in_words(files::changed_settings(files::settings_in_force(*map.machine()),
                                              files::settings_in_force(after))),
      changed->with_these_mm,
      changed->as_it_is_mm,
      changed->check.sentence);
  return std::move(changed->check);
}

}  // namespace chaintrue::cli
