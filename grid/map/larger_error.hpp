// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// A map whose expected error is multiplied, where something says that it is larger than the fit
/// itself can know. Its lengths stay.
#pragma once

#include <stdexcept>
#include <utility>
#include <variant>

#include "grid/map/map_parts.hpp"

namespace chaintrue::grid {

/// Everywhere, by a factor of at least 1. \throws std::invalid_argument for a map that knows no
/// machine, or a smaller factor.
[[nodiscard]] inline CompensationMap with_larger_error(const CompensationMap& map, double factor) {
  MapContents contents = map.contents();
  auto* surface = std::get_if<ModelSurface>(&contents.surface);
  if (surface == nullptr || !(factor >= 1.0))
    throw std::invalid_argument("a larger error of a direct map, or by a factor below 1");
  surface->covariance_factor *= factor;
  return with_expected_error(std::move(contents));
}

}  // namespace chaintrue::grid
