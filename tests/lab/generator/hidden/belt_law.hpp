// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws that no catalogue lists, and fields that are no law, in the reading of one of four belts.
/// Written independently of the product's list.
#pragma once

#include <string_view>
#include <vector>

#include "generator/hidden/belt_strength.hpp"
#include "generator/hidden/law.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::generator {

/// No step over y: where rows are visited one after the other it is a zero that moves, a listed cause.
enum class BeltLawFamily {
  // of one variable
  step_along_x,
  slope_from_x,      ///< level, then rising from a place on
  slope_from_y,
  ripple_of_length,  ///< a wave of the belt's own length
  ripple_of_angle,   ///< of its direction
  ripple_along_x,
  // of two
  product_of_two,
  gaussian_field,
};
inline constexpr std::size_t kBeltLawsOfOne = 6;
[[nodiscard]] std::string_view word(BeltLawFamily family);

struct BeltLaw {
  BeltLawFamily family = BeltLawFamily::step_along_x;
  std::size_t belt = 0;  ///< tl, tr, bl, br
  double size_mm = 1.0;
  double place = 0.0;   ///< mm in the frame
  double extent = 0.0;  ///< period, mm or rad; of a field its length
  double phase = 0.0;
  double sign = 1.0;  ///< the sense in which a slope rises
  std::vector<HiddenWave> waves{};
  double strength = 0.0;  ///< not explained by the anchors and any single cause, in sigmas
};

/// For size 1, at a position and the belt's length there.
[[nodiscard]] double value_of(const BeltLaw& law, const BeltFrame& frame, double x, double y, double length_mm);

/// Everything but size and strength.
[[nodiscard]] BeltLaw drawn_belt_law(BeltLawFamily family,
                                     const std::vector<std::array<double, 2>>& places,
                                     Dice& dice);

}  // namespace chaintrue::generator
