// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The settings that GroundControl and WebControl share, independent of the file format. Private to
/// grid/files.
#pragma once

#include "grid/files/groundcontrol_file.hpp"
#include "grid/files/setting_reader.hpp"

namespace chaintrue::grid::files {

/// As in groundcontrol_file.hpp; paths are "maslow settings/bedwidth". \throws InputError with every problem of the file.
[[nodiscard]] ReadMachine machine_of_settings(SettingTexts texts,
                                              Tolerances tolerances,
                                              Problems& problems);

}  // namespace chaintrue::grid::files
