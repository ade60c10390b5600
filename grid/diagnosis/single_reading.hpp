// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A lasting cause acts on more than one reading: a name that a single one makes is refused, and
/// that reading is set aside to be measured again.
#pragma once

#include <optional>
#include <string>

#include "grid/diagnosis/analysis.hpp"

namespace chaintrue::grid::diagnosis {

/// Where, without one reading, nothing would be named: decides `analysis` anew with that reading
/// set aside and says so in a sentence. Nothing is done where the name stands, where a set is left,
/// or where the cause is a slip or a skip, which may show in one reading alone.
[[nodiscard]] std::optional<std::string> refuse_name_of_one_reading(
    const std::optional<Stability>& stability, Analysis& analysis);

}  // namespace chaintrue::grid::diagnosis
