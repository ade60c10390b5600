// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine's settings from any program: groundcontrol.ini, webcontrol.json, FluidNC's yaml, or a
/// chaintrue_machine; and a map's machine with a controller that has these settings.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "grid/files/machine_file.hpp"
#include "grid/map/map_check.hpp"
#include "model/controllers/controller.hpp"
#include "model/machine.hpp"
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

struct SettingsFile {
  std::string name;  ///< in messages
  files::ReadMachine read;
  /// Whether it is a file of this program.
  bool is_ours = false;
};

/// \throws InputError with every problem of the file.
SettingsFile read_settings_file(const std::string& path);
/// As above, from its text.
SettingsFile parse_settings_file(const std::string& path, const std::string& text);

/// `stated`, a map's machine as stated, with a controller that has `now`. A map without a
/// controller gets the file's. Reports in one line on standard error what differs from the settings
/// that the map was measured with. \param in_place the controller of --controller, for which the
/// settings are read; or null
/// \throws InputError for settings of another kind of controller, or that change the meaning
/// of the map's chain lengths.
[[nodiscard]] Machine with_settings(const Machine& stated, const SettingsFile& now,
                                    const ControllerKind* in_place);

/// map.json becomes map.after.json: where export writes the map for the typed-in numbers by
/// default.
std::string after_name(const std::string& map);

/// "maslow_classic", as in files and options.
std::string_view name_of(ControllerKind kind);

// A check whose points were commanded with settings other than the map's: those of a file, or the
// numbers of export groundcontrol if all or some were typed in since the map was measured, or not
// typed in although the map is for them. This is reported, and the check uses the map for the
// settings in force.

/// The map for the settings in the file `settings`; `measured` is recomputed for commands with
/// these. `map_name` is for messages.
/// \throws InputError for a bad file, settings of a wall plotter, or a map without a machine.
[[nodiscard]] CompensationMap with_settings_of(const std::string& settings,
                                               const std::string& map_name,
                                               const CompensationMap& map,
                                               grid::Measured& measured);

/// Whether a map was made from the file `from` with its present content.
bool was_made_from(const std::string& made, const std::string& from);

/// The controller's settings for the map from which export made this one, if that map is next to it
/// unchanged.
std::optional<model::ControllerSettings> settings_before(const std::string& map);

/// `found` is the check of `map` against `measured`. Empty if the map's settings fit, or if the
/// others do not explain the points either. The others are those of `before`, the settings before
/// the map's numbers; else those of export groundcontrol.
[[nodiscard]] std::optional<grid::Check> with_typed_settings(
    const CompensationMap& map, const grid::Measured& measured, const grid::Check& found,
    std::optional<model::ControllerSettings> before = {});

}  // namespace chaintrue::cli
