// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The sections of a fit of four belts that are words and tables.
#pragma once

#include "tools/cli/anchors_document.hpp"

namespace chaintrue::cli {

/// What one belt's reading is off by, and what the machine says of the same. Precondition: places.
[[nodiscard]] report::Section agreement_section(const FittedBelts& fitted);
[[nodiscard]] report::Section fitted_anchors_section(const grid::BeltsFit& fit);
/// What was left out and predicted, what was rejected, the scale, the holes.
[[nodiscard]] report::Section tests_section(const FittedBelts& fitted);
/// Each place with what its belts are off by.
[[nodiscard]] report::Section places_section(const grid::BeltsFit& fit);
/// Each distance with what it is off by.
[[nodiscard]] report::Section taped_section(const grid::HolesWithBelts& holes);

}  // namespace chaintrue::cli
