// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The true error of the tool with the result of a diagnosis, from the hidden machine itself,
/// compared with the error if the cause is given.
#pragma once

#include <optional>

#include "generator/hidden/draw.hpp"
#include "grid/diagnosis/diagnosis.hpp"

namespace chaintrue::sealed {

/// Errors of the tool on a fresh session without noise [mm, rms].
struct TrueErrors {
  double calibrated = 0.0;
  double extended = 0.0;       ///< with the diagnosis's machine
  double oracle = 0.0;         ///< given the cause
  double reported_drop = 0.0;  ///< of the mean square, as reported by the diagnosis
  double reported_share = 0.0;
};

/// Empty if a fit or a prediction fails.
std::optional<TrueErrors> true_errors(const generator::SealedSet& set,
                                      const grid::diagnosis::Diagnosis& found);

}  // namespace chaintrue::sealed
