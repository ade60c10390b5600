// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// chaintrue_map files: a compensation map with its machine, surface, hull, noise, covariance and
/// its own error. Unknown keys are errors, except "comment". Same map, same bytes.
///
/// It ends in a "content_hash" over everything else (SHA-256; layout and comments do not
/// count): a map that does not match it is rejected, since its chain lengths would be
/// silently wrong.
///
/// The covariance of the unknowns is kept as the rows of its lower triangular factor, to seven
/// digits: a sigma is never known better.
#pragma once

#include <optional>
#include <string>

#include "grid/files/input_error.hpp"
#include "grid/map/compensation_map.hpp"
#include "grid/provenance.hpp"

namespace chaintrue::grid::files {

/// `file` is the name used in messages. \throws InputError with every problem of the file.
CompensationMap parse_map(const std::string& text, const std::string& file);
std::string write_map(const CompensationMap& map,
                      const std::optional<Provenance>& made_by = std::nullopt);

}  // namespace chaintrue::grid::files
