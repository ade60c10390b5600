// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Compares the tool error that an owner of four belts wishes for with the expected one. To reach
/// it, compensated programs and two to four times as many visits, in a session simulated from the
/// fit, are tried.
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
#include "tools/cli/names.hpp"

namespace chaintrue::cli {

/// `belts` (without points if only holes were fitted) and `cut` are the input of `found`; `error`
/// is its error_of_belts(). `wish_mm` is the rms error of the tool over the measured part.
[[nodiscard]] std::string belts_wish_sentence(const MeasuredBelts& belts,
                                              const std::vector<grid::BeltHoles>& cut,
                                              const files::FittedAnchors& found,
                                              const std::optional<BeltsError>& error,
                                              double wish_mm);

}  // namespace chaintrue::cli
