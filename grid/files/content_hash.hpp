// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Whether a file still says what was once written into it. Private to grid/files.
///
/// FNV-1a, 64 bits (http://www.isthe.com/chongo/tech/comp/fnv/), over the values as the writer
/// would write them on one line: layout and comments do not count, every number, name and key does.
/// It finds slips and damage; it is no protection against somebody who computes it anew.
#pragma once

#include <string>

#include "grid/files/json_text.hpp"

namespace chaintrue::grid::files {

/// 16 hexadecimal digits. The root's "content_hash" and "comment" keys anywhere are left out.
[[nodiscard]] std::string content_hash(const Json& document);

}  // namespace chaintrue::grid::files
