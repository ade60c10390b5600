// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// --outside and --fade-mm: a map's continuation beyond its points, shared by several verbs.
#pragma once

#include <string>

#include "grid/map/compensation_map.hpp"
#include "tools/cli/verb.hpp"

namespace chaintrue::cli {

struct OutsideOption {
  std::string way;
  double fade_width_mm = grid::OutsideRule{}.fade_width_mm;
};

/// \param usual what happens without the option, in words
void add_outside_options(Verb verb, OutsideOption& option, const std::string& usual);
/// The requested rule, or the given one.
[[nodiscard]] grid::OutsideRule rule_of(const OutsideOption& option,
                                        const grid::OutsideRule& usual);

}  // namespace chaintrue::cli
