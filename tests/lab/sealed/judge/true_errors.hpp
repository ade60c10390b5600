// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The true error of the tool with the result of a diagnosis, from the hidden machine itself,
/// compared with the error if the cause is given.
#pragma once

#include <optional>

#include "sealed/judge/trial.hpp"

namespace chaintrue::sealed {

/// Empty if a fit or a prediction fails.
[[nodiscard]] std::optional<TrueErrors> true_errors(const generator::SealedSet& set,
                                                    const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::sealed
