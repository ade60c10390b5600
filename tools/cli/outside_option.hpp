// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// --outside and --fade-mm: what a map does beyond its points, for every verb that asks.
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
/// The rule that was asked for, or the given one.
[[nodiscard]] grid::OutsideRule rule_of(const OutsideOption& option,
                                        const grid::OutsideRule& usual);

}  // namespace chaintrue::cli
