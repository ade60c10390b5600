// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// The coordinates of a place where readings were taken, on which a pattern, a law or a residual
/// may be a function.
///
/// \code
///   unit_of(Coordinate::tension_left);                        // "n"
///   chain_of(Coordinate::tension_left) == model::Side::left;
///   value_at(place, Coordinate::tension_left);                // newtons
/// \endcode
#pragma once

#include <optional>
#include <string_view>

#include "model/belts/belt.hpp"
#include "model/coordinates.hpp"

namespace chaintrue::grid::estimation {
struct SystemPlace;
}

namespace chaintrue::grid::diagnosis {

enum class Coordinate {
  x,              ///< mm
  y,              ///< mm
  across,         ///< mm, over the bed in any direction
  border,         ///< mm, from the nearest border of the bed inwards
  length_left,    ///< mm
  length_right,   ///< mm
  angle_left,     ///< rad
  angle_right,    ///< rad
  tension_left,   ///< N, at the sprocket
  tension_right,  ///< N
  visit,          ///< number of the visit
  length_tl,      ///< mm, of a belt
  length_tr,      ///< mm
  length_bl,      ///< mm
  length_br,      ///< mm
  angle_tl,       ///< rad, of a belt against the horizontal, at its anchor
  angle_tr,       ///< rad
  angle_bl,       ///< rad
  angle_br,       ///< rad
  place,          ///< both x and y
};
/// Its name in files.
std::string_view name(Coordinate of);
/// "mm", "rad", "n", "visit": what a parameter's name ends in.
std::string_view unit_of(Coordinate of);
/// The chain or belt that it belongs to, if any.
std::optional<Side> chain_of(Coordinate of);
std::optional<Belt> belt_of(Coordinate of);

/// `across_rad`: of Coordinate::across, from x towards y. \pre A coordinate of such a machine, and not the place.
double value_at(const estimation::SystemPlace& place, Coordinate of, double across_rad = 0.0);

}  // namespace chaintrue::grid::diagnosis
