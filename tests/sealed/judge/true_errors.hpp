// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// How wrong the tool would be with what a diagnosis made of the data, against the hidden machine
/// itself and against somebody who was told the cause.
#pragma once

#include <optional>

#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// Nothing where a fit or a prediction fails.
[[nodiscard]] std::optional<TrueErrors> true_errors(const generator::SealedSet& set,
                                                    const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::sealed
