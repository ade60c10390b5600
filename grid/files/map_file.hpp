// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_map files: a compensation map with its machine, surface, hull, noise, covariance and
/// its own error. Unknown keys are errors, except "comment". Same map, same bytes.
///
/// The covariance of the unknowns is kept as the rows of its lower triangular factor, to seven
/// digits: a sigma is never worth more.
#pragma once

#include <filesystem>
#include <string>

#include "grid/map/compensation_map.hpp"

namespace chaintrue::grid::files {

/// "-" reads standard input. \throws InputError with every problem of the file.
[[nodiscard]] CompensationMap read_map(const std::filesystem::path& path);
[[nodiscard]] CompensationMap parse_map(const std::string& text, const std::string& file);
[[nodiscard]] std::string write_map(const CompensationMap& map);

}  // namespace chaintrue::grid::files
