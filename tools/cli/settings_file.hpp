// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine's settings from any program: groundcontrol.ini, webcontrol.json, FluidNC's yaml, or a
/// chaintrue_machine; and a map's machine with a controller that has these settings.
#pragma once

#include <string>
#include <string_view>

#include "grid/files/machine_file.hpp"
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
[[nodiscard]] SettingsFile read_settings_file(const std::string& path);
/// As above, from its text.
[[nodiscard]] SettingsFile parse_settings_file(const std::string& path, const std::string& text);

/// `stated`, a map's machine as stated, with a controller that has `now`. A map without a
/// controller gets the file's. Reports in one line on standard error what differs from the settings
/// that the map was measured with. \param in_place the controller of --controller, for which the
/// settings are read; or null
/// \throws InputError for settings of another kind of controller, or that change the meaning
/// of the map's chain lengths.
[[nodiscard]] Machine with_settings(const Machine& stated,
                                    const SettingsFile& now,
                                    const ControllerKind* in_place);

/// map.json becomes map.after.json: where export writes the map for the typed-in numbers by
/// default.
[[nodiscard]] std::string after_name(const std::string& map);

/// "maslow_classic", as in files and options.
[[nodiscard]] std::string_view name_of(ControllerKind kind);

}  // namespace chaintrue::cli
