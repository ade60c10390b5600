// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sentences of a verdict that every machine shares, in the vocabulary of the machine at hand. Private to
/// grid/diagnosis.
#pragma once

#include <string>
#include <vector>

#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// "Most likely ...", "One of 2 causes ...", "3 causes act together ...", and the pattern beside them. Empty where the
/// verdict names no cause.
[[nodiscard]] std::string causes_in_words(const Diagnosis& diagnosis);

/// That the readings follow the law that is claimed, and what it changes of what is named; empty where none is claimed.
[[nodiscard]] std::string claimed_law_in_words(const Diagnosis& diagnosis);

/// The outliers, one each.
[[nodiscard]] std::vector<std::string> outliers_in_words(const Diagnosis& diagnosis);
/// That nothing but these is wrong.
[[nodiscard]] std::string only_outliers_in_words(const Diagnosis& diagnosis);

/// What a verdict proves no more.
[[nodiscard]] std::string not_proved_in_words(const Diagnosis& diagnosis);

}  // namespace chaintrue::grid::diagnosis
