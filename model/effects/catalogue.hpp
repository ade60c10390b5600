// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The catalogue of effects of two chains, and the effects of a machine file looked up in it.
///
/// \code
///   for (const Effect* effect : catalogue()) fmt::print("{}: {}\n", effect->id, effect->cause);
///   for (const MachineProblem& p : problems_of_effects(machine)) say(p.parameter, p.expected);
/// \endcode
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "model/effects/effect_table.hpp"

namespace chaintrue::model::effects {

/// Every effect of chains/chain_effects.cpp.
EffectTable catalogue();
/// Null if no effect of the catalogue has this name.
const Effect* find_effect(std::string_view id);

/// The catalogue, then the effects declared for a machine. A declared effect that replaces one of
/// the catalogue takes its position.
std::vector<const Effect*> listed_effects(const Machine& machine);
/// Those that may act on the machine: a ring has no effects of brackets, and brackets none of a
/// ring.
std::vector<const Effect*> effects_of(const Machine& machine);
/// The one with this name among these; null if there is none.
const Effect* find_effect(const Machine& machine, std::string_view id);

/// All problems of the machine's effects, each with its JSON pointer below the machine
/// ("/effects/0/side"): unknown effects, sides and parameters, missing parameters, values out of
/// range, effects of a part that the machine lacks, and sums that are not physical (a chain without mass, a
/// ring without radius). Empty: the
/// effects are valid.
[[nodiscard]] std::vector<MachineProblem> problems_of_effects(const Machine& machine);

/// The machine's effects in the order of effects_of().
/// \throws std::invalid_argument with the first of problems_of_effects where there is one.
std::vector<ActingEffect> acting_effects(const Machine& machine);

/// The effect as in a machine file: `applied(effect, EffectSide::left, values)`.
AppliedEffect applied(const Effect& effect, EffectSide side, Values values);
/// In the order of the parameters.
std::vector<double> nominal_values(const Effect& effect);
/// The effect of the machine's mirror image.
ActingEffect mirrored(const ActingEffect& acting);

/// The text of docs/effects.md, from the table.
std::string catalogue_document();

}  // namespace chaintrue::model::effects
