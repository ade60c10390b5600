// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The figures of sets with a pattern that is in no catalogue, alone or together with causes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sealed/judge/table.hpp"

namespace chaintrue::sealed {

/// A pattern is reported: its probability is above one half.
[[nodiscard]] bool tells_pattern(const Trial& trial);
/// Named alone or together with others, not as one of a set of alternatives.
[[nodiscard]] bool names_outright(const Trial& trial);
/// Something is named, or a set of alternatives is given, without the hidden cause; or one of
/// several names is not hidden.
[[nodiscard]] bool names_wrongly(const Trial& trial);

/// Rows of a table, each with a text and a share.
[[nodiscard]] std::vector<std::pair<std::string, Share>> pattern_rows(
    const std::vector<Trial>& trials);

}  // namespace chaintrue::sealed
