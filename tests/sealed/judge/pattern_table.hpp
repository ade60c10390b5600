// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The figures of sets with a pattern that no catalogue lists, alone or beside causes.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sealed/judge/table.hpp"

namespace chaintrue::sealed {

/// A pattern is told of: its probability is beyond one half.
[[nodiscard]] bool tells_pattern(const Trial& trial);
/// Named outright, alone or among several: not one of a set.
[[nodiscard]] bool names_outright(const Trial& trial);
/// Something is named outright, or a set is given, without what is hidden in it; or an outright
/// name among others that are right is of nothing hidden.
[[nodiscard]] bool names_wrongly(const Trial& trial);

/// Rows of a table: words and a share each.
[[nodiscard]] std::vector<std::pair<std::string, Share>> pattern_rows(
    const std::vector<Trial>& trials);

}  // namespace chaintrue::sealed
