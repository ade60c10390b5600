// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The meaning of every key of every file, for reference pages and editors. Private to grid/files.
/// Complete for all records (tests/grid_files/format_pages_test.cpp).
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::grid::files {

/// `noun` as in the record ("a sprocket"). Returns a sentence; empty for an unknown key.
[[nodiscard]] std::string meaning_of(std::string_view noun, std::string_view key);

}  // namespace chaintrue::grid::files
