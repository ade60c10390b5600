// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// What changed since an earlier diagnosis of the same machine: which cause grew, by how much and
/// how surely.
///
/// Two diagnoses are independent measurements, so that a difference has the root of the sum of
/// both squares of sigma, and a chance to be of its sign of Phi(difference / sigma). Sizes that a
/// diagnosis names are those of its causes together; of others what they would be alone.
#pragma once

#include <string>

#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// Of all causes that either names. `since`: what the earlier one is called.
[[nodiscard]] Trend trend(const Diagnosis& before, const Diagnosis& now, std::string since);

/// A change in a sentence: "chain pitch error, left grew from ... to ...: 99 % sure".
[[nodiscard]] std::string change_in_words(const Change& change);

}  // namespace chaintrue::grid::diagnosis
