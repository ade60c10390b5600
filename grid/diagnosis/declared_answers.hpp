// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The result of a session for declared effects, such as a law that an earlier session found.
///
///   confirmed     named, at kLawClaimed and more
///   denied        no more than 1 - kLawClaimed, and it would have been detected with the file's size: its size
///                 lies below the usual one at 95 %, or the readings are likelier without it than with its
///                 usual values, by the odds of kLawClaimed
///   open          neither
///   not testable  these readings do not show it, whatever its size
///
///   odds = p(e | S, D) / p(e - g | S, D),   g its signature at the usual values; S, D the best
///                                           model without it
///
/// \code
///   for (const DeclaredAnswer& one : declared_answers(analysis, diagnosis)) ...
/// \endcode
#pragma once

#include <vector>

#include "grid/diagnosis/analysis.hpp"
#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::grid::diagnosis {

/// An answer for each side of each declared effect, in the order of the machine's. `found` with its causes,
/// bounds and what is not testable.
[[nodiscard]] std::vector<DeclaredAnswer> declared_answers(const Analysis& analysis,
                                                           const Diagnosis& found);

}  // namespace chaintrue::grid::diagnosis
