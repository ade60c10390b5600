// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The map that a verb works with; what is odd about it is told on standard error.
#pragma once

#include <string>

#include "grid/map/compensation_map.hpp"

namespace chaintrue::cli {

/// "-" is standard input. \throws files::InputError.
[[nodiscard]] grid::CompensationMap read_map_input(const std::string& path);
/// Of a map that was read already; `file` is what messages call it.
[[nodiscard]] grid::CompensationMap parse_map_input(const std::string& text,
                                                    const std::string& file);

/// What messages call a map that was read and carries no hash of its content; empty where there is
/// none. Its numbers are each possible, but nobody knows whether they belong together.
[[nodiscard]] const std::string& map_on_trust();

}  // namespace chaintrue::cli
