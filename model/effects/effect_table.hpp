// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Effects of a file looked up in a mechanism's table: their problems and their values.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "model/effects/effect.hpp"
#include "model/machine.hpp"

namespace chaintrue::model::effects {

/// In the order in which they act.
using EffectTable = std::span<const Effect* const>;

/// Null if no effect of the table has this name.
const Effect* find_effect(EffectTable table, std::string_view id);

/// Unknown effects, sides and parameters, values out of range, and with `all_stated` missing values.
/// Places are "/0/side", "/0/parameters/scale" and the like, by the effect's number.
[[nodiscard]] std::vector<MachineProblem> problems_in(EffectTable table,
                                                      const std::vector<AppliedEffect>& applied,
                                                      bool all_stated = false);

/// An effect with its side and its values, looked up once.
struct ActingEffect {
  const Effect* effect = nullptr;
  EffectSide side = EffectSide::none;
  std::vector<double> values;
};
/// In the table's order. Values that are not stated are nominal. \throws std::logic_error for
/// effects with problems.
std::vector<ActingEffect> resolve(EffectTable table, const std::vector<AppliedEffect>& applied);

}  // namespace chaintrue::model::effects
