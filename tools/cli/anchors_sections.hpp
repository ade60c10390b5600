// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a fit of four belts that are words and tables.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "grid/belts/belts_error.hpp"
#include "tools/cli/anchors_document.hpp"

namespace chaintrue::cli {

/// By how much the machine misses, today and with these anchors.
[[nodiscard]] std::string headline_of(const grid::BeltsFit& fit,
                                      const std::optional<grid::BeltsError>& error);
/// Why these anchors are not to be pasted: they leave more than kMostToCutWithMm, or are that uncertain
/// where nobody can say what they leave. Empty of any other.
[[nodiscard]] std::string not_to_paste(const grid::BeltsFit& fit,
                                       const std::optional<grid::BeltsError>& error);
[[nodiscard]] std::vector<report::Figure> figures_of(const grid::BeltsError& error);

/// Where the anchors are least sure, what acts with them, what one belt's reading is off by and what
/// the machine says of the same.
[[nodiscard]] report::Section agreement_section(const FittedBelts& fitted,
                                                const std::optional<grid::BeltsError>& error);
[[nodiscard]] report::Section fitted_anchors_section(const grid::BeltsFit& fit);
/// What was left out and predicted, what was rejected, the scale, the holes.
[[nodiscard]] report::Section tests_section(const FittedBelts& fitted);
/// Each place with what its belts are off by.
[[nodiscard]] report::Section places_section(const FittedBelts& fitted);
/// Each distance with what it is off by.
[[nodiscard]] report::Section taped_section(const grid::HolesWithBelts& holes);

}  // namespace chaintrue::cli
