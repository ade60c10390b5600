// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A machine's settings, whoever keeps them: groundcontrol.ini, webcontrol.json, FluidNC's yaml, or
/// a chaintrue_machine; and a map's machine whose controller holds such settings now.
#pragma once

#include <string>
#include <string_view>

#include "grid/files/machine_file.hpp"
#include "model/machine.hpp"

namespace chaintrue::cli {

struct SettingsFile {
  std::string name;  ///< in messages
  grid::files::ReadMachine read;
  /// It is this program's own file.
  bool is_ours = false;
};

/// \throws files::InputError with every problem of the file.
[[nodiscard]] SettingsFile read_settings_file(const std::string& path);
/// The same of a text that was read from there.
[[nodiscard]] SettingsFile parse_settings_file(const std::string& path, const std::string& text);

/// `stated`, the machine of a map as it was stated, with the controller that holds `now`. A map that
/// names no controller takes the file's. Says on standard error, in one line, what differs from the
/// settings that the map was measured with.
/// \param in_place the controller of --controller, as which the settings are read; or null
/// \throws files::InputError for settings of another kind of controller, or with which the chain
/// lengths of the map would mean something else.
[[nodiscard]] model::Machine with_settings(const model::Machine& stated,
                                           const SettingsFile& now,
                                           const model::ControllerKind* in_place);

/// map.json becomes map.after.json: where export writes the map that is right once its numbers are
/// typed in, unless somebody says another place.
[[nodiscard]] std::string after_name(const std::string& map);

/// "maslow_classic", as files and options have it.
[[nodiscard]] std::string_view name_of(model::ControllerKind kind);

}  // namespace chaintrue::cli
