// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A law in words for a workshop.
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/law.hpp"
#include "model/belts/belt_machine.hpp"
#include "model/effects/declared_effect.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::diagnosis {

/// "a wave of 0.40 +- 0.03 mm over the length of the left chain with period 63.6 +- 0.4 mm, in the left
/// chain". Without its probability.
std::string in_words(const Law& law);

/// "the left chain's length": its variable.
std::string variable_in_words(const Law& law);

/// "moves the tool by 0.41 mm" or, for distances and belts, "changes a distance by": on average.
std::string average_in_words(const Law& law, Observations of);

/// " Given this law, they also name a stretched left chain (...), 96 %." and what they would
/// name without it; empty if the law changes no name. \pre A law is
/// claimed.
std::string given_law_words(const Diagnosis& d);

/// Hints, as sentences: what on this machine has about this period or place.
std::vector<std::string> hints_of(const Law& law, const Machine& machine);
std::vector<std::string> hints_of(const Law& law, const BeltMachine& machine);

// A law as a cause of the user's own (model/effects/declared_effect.hpp), so that later
// diagnoses can name it and a user can edit it.
//
// A place and a phase are the effect's place; a period, a scale and the range are numbers in the formula,
// to be edited there. A movement of the tool is written as its effect on either chain: side
// cos(phi) of it along x, -sin(phi) along y. A chain's formula cannot express a law that moves the
// tool outwards over every border, or one that depends on the other chain: both are refused.

/// Or a sentence with the reason.
[[nodiscard]] tl::expected<model::effects::Declaration, std::string> declaration_of(const Law& law,
                                                                                    const Bed& bed);
/// For the likeliest law of a list, which must be at least kLawClaimed.
[[nodiscard]] tl::expected<model::effects::Declaration, std::string> declaration_of(
    const std::vector<Law>& laws, const Bed& bed);

}  // namespace chaintrue::grid::diagnosis
