// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Effects of a file looked up in a mechanism's own table: what is wrong with them, and their values.
/// Values that a file leaves out are nominal.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "model/effects/catalogue.hpp"

namespace chaintrue::model::effects {

using EffectTable = std::span<const Effect* const>;

/// Null where none of the table has this name.
[[nodiscard]] const Effect* find_effect(EffectTable table, std::string_view id);

/// Unknown effects, sides and parameters, values out of range. Places are "/0/side" and the like, by
/// the effect's number.
[[nodiscard]] std::vector<MachineProblem> problems_in(EffectTable table,
                                                      const std::vector<AppliedEffect>& applied);

/// In the table's order, each with its number in it.
struct TableEffect {
  std::size_t number = 0;
  EffectSide side = EffectSide::none;
  std::vector<double> values;
};
/// \throws std::logic_error for effects with problems.
[[nodiscard]] std::vector<TableEffect> resolve(EffectTable table,
                                               const std::vector<AppliedEffect>& applied);

}  // namespace chaintrue::model::effects
