// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Keys shared by several parts of a chaintrue_diagnosis file. Private to grid/files.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/files/json_reader.hpp"

namespace chaintrue::grid::files {

/// The side of an effect, as in files.
[[nodiscard]] inline Value<std::string> side_word() {
  return one_of({"left", "right", "both", "x", "y", "tl", "tr", "bl", "br", "all"});
}

[[nodiscard]] Value<diagnosis::Verdict> verdict_word();

}  // namespace chaintrue::grid::files
