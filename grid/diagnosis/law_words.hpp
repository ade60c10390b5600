// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A law in words for a workshop.
#pragma once

#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"
#include "grid/diagnosis/law.hpp"
#include "model/belts/belt_machine.hpp"
#include "model/machine.hpp"

namespace chaintrue::grid::diagnosis {

/// "a wave of 0.40 +- 0.03 mm over the length of the left chain with period 63.6 +- 0.4 mm, in the left
/// chain". Without its probability.
std::string in_words(const Law& law);

/// "the left chain's length": its variable.
std::string variable_in_words(const Law& law);

/// "a wave over the left chain's length".
std::string form_in_words(const Law& law);

/// "moves the tool by 0.41 mm" or, for distances and belts, "changes a distance by": on average.
std::string average_in_words(const Law& law, Observations of);

/// " Given this law, they also name a stretched left chain (...), 96 %." and what they would
/// name without it; empty if the law changes no name. \pre A law is
/// claimed.
std::string given_law_words(const Diagnosis& d);

/// Hints, as sentences: what on this machine has about this period or place.
std::vector<std::string> hints_of(const Law& law, const model::Machine& machine);
std::vector<std::string> hints_of(const Law& law, const model::BeltMachine& machine);

}  // namespace chaintrue::grid::diagnosis
