// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a fit of four belts that consist of text and tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_error.hpp"
#include "tools/cli/anchors_document.hpp"

namespace chaintrue::cli {

/// The machine's error, today and with these anchors.
[[nodiscard]] std::string headline_of(const BeltsFit& fit, const std::optional<BeltsError>& error);
/// Why these anchors must not be pasted: their error exceeds kMostToCutWithMm or, if it is unknown,
/// their uncertainty does. Otherwise empty.
[[nodiscard]] std::string not_to_paste(const BeltsFit& fit, const std::optional<BeltsError>& error);
[[nodiscard]] std::vector<Figure> figures_of(const BeltsError& error);

/// The least certain anchors, the causes, the error of one belt's reading, and the machine's figure
/// for it.
[[nodiscard]] Section agreement_section(const FittedBelts& fitted,
                                        const std::optional<BeltsError>& error);
[[nodiscard]] Section fitted_anchors_section(const BeltsFit& fit);
/// Errors at left-out readings, rejected readings, the scale and the holes.
[[nodiscard]] Section tests_section(const FittedBelts& fitted);
/// Each place with the residuals of its belts.
[[nodiscard]] Section places_section(const FittedBelts& fitted);
/// Each distance with its residual.
[[nodiscard]] Section taped_section(const grid::HolesWithBelts& holes);

}  // namespace chaintrue::cli
