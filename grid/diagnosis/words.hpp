// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sentences of a verdict that all machines share, in the current machine's vocabulary. Private
/// to grid/diagnosis.
#pragma once

#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// "Most likely ...", "One of 2 causes ...", "3 causes act together ...", and the pattern besides
/// them. Empty if the verdict names no cause.
std::string causes_in_words(const Diagnosis& diagnosis);

/// The claimed law and its effect on the names; empty if none is claimed.
std::string claimed_law_in_words(const Diagnosis& diagnosis);

/// "a; b and c": the outliers.
std::string outliers_in_words(const Diagnosis& diagnosis);
/// The sentence that only these are wrong.
std::string only_outliers_in_words(const Diagnosis& diagnosis);

/// What to do about the causes, in at most two lines; empty for a set, of which only one acts.
void say_remedies(Diagnosis& diagnosis);

/// "Measure next: `first`, and 3 more below. All of it raises the chance of a single name to 96 %."
std::string next_in_words(const Diagnosis& diagnosis, std::string_view first,
                          const std::vector<NextMeasurement>& all);

/// "one explanation alone" or "a single name".
std::string_view aim_of(const Diagnosis& diagnosis);

/// What a verdict does not prove.
std::string not_proved_in_words(const Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
