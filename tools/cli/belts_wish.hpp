// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The error of the tool that an owner of four belts wishes for, held against the one to expect with
/// the fitted anchors. What would reach it is tried: the bend that compensated programs take out, and
/// the same places measured two to four times over, in a session simulated by the fit.
///
/// \code
///   say(belts_wish_sentence(belts, holes, found, error_of_belts(found.fit), 0.5));
///   // "You wish for 0.5 mm: not reached. About 62 places measured as well as these would reach it."
/// \endcode
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_error.hpp"
#include "grid/files/anchors_file.hpp"

namespace chaintrue::cli {

/// `belts` and `cut` are what `found` was fitted to, without points where only holes were; `error` is
/// what error_of_belts() says of it. `wish_mm` is the rms error of the tool over the measured part.
[[nodiscard]] std::string belts_wish_sentence(const grid::MeasuredBelts& belts,
                                              const std::vector<grid::BeltHoles>& cut,
                                              const grid::files::FittedAnchors& found,
                                              const std::optional<grid::BeltsError>& error,
                                              double wish_mm);

}  // namespace chaintrue::cli
