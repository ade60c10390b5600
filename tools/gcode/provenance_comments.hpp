// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Where a compensated program comes from, as comments of its head:
///
///     (chaintrue 0.1.0, gcode compensate)
///     (option --tolerance-mm 0.1)
///     (from map.json)
///     (sha256 begins 0f343b0931126a20f133d67c2b018a3b)
#pragma once

#include <string>
#include <vector>

#include "grid/provenance.hpp"
#include "tools/gcode/line_source.hpp"

namespace chaintrue::gcode {

/// The whole hash does not fit into a line.
inline constexpr std::size_t kHashDigits = 32;

/// At most `longest` characters a line. Characters that a controller might act on in a comment are
/// replaced by _.
[[nodiscard]] std::vector<std::string> comments_of(const grid::Provenance& made_by,
                                                   std::size_t longest);

/// The beginnings of the hashes that the comments at the beginning of a program hold; none where it
/// has no such comments or cannot be read.
[[nodiscard]] std::vector<std::string> hashes_in_head(LineSource program);

}  // namespace chaintrue::gcode
