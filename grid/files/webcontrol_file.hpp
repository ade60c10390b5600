// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// WebControl's webcontrol.json: GroundControl's settings, each an object with its key and its value
/// in a list for each section:
///
///   { "Maslow Settings": [ {"key": "motorSpacingX", "value": "2978.4", ...}, ... ],
///     "Advanced Settings": [ ... ] }
///
/// Everything else is as in groundcontrol_file.hpp. Source: WebControlCNC/WebControl,
/// defaultwebcontrol.json.
#pragma once

#include <string>

#include "grid/files/machine_file.hpp"

namespace chaintrue::grid::files {

/// True for JSON with its two sections. \throws InputError for a text that is not JSON.
[[nodiscard]] bool is_webcontrol(const std::string& text, const std::string& file);
/// `file` is the name used in messages and, without its folder, the machine's.
/// \throws InputError with every problem of the file.
[[nodiscard]] ReadMachine parse_webcontrol(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
