// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What a file says that it is, for verbs that take several kinds.
#pragma once

#include <string>

namespace chaintrue::grid::files {

/// The value of "file_type" in a JSON object; empty where there is none. `file` is the name used in
/// messages. \throws InputError for a text that is not JSON.
[[nodiscard]] std::string file_type_of(const std::string& text, const std::string& file);

}  // namespace chaintrue::grid::files
