// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What each key of each file means, for reference pages and editors. Private to grid/files. Every
/// key that a record has stands here (tests/grid_files/format_pages_test.cpp).
#pragma once

#include <string>
#include <string_view>

namespace chaintrue::grid::files {

/// `noun` as the record has it ("a sprocket"); a sentence, or nothing where the key is unknown.
[[nodiscard]] std::string meaning_of(std::string_view noun, std::string_view key);

}  // namespace chaintrue::grid::files
