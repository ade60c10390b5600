// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws and fields in the reading of one of four belts. Written independently of the product's list.
#pragma once

#include <array>
#include <vector>

#include "generator/hidden/belts.hpp"
#include "generator/hidden/law.hpp"
#include "generator/hidden/random.hpp"

namespace chaintrue::generator {

/// Those of one variable first. No step over y: where rows are visited one after the other it is a zero that moves, a
/// listed cause.
inline constexpr std::array kBeltLaws = {LawFamily::step_along_x,    LawFamily::slope_from_x,
                                         LawFamily::slope_from_y,    LawFamily::ripple_of_length,
                                         LawFamily::ripple_of_angle, LawFamily::ripple_along_x,
                                         LawFamily::product_of_two,  LawFamily::gaussian_field};
inline constexpr std::size_t kBeltLawsOfOne = 6;

/// Everything but the size; `chain` and `component` are the belt (tl, tr, bl, br).
HiddenLaw drawn_belt_law(LawFamily family, const std::vector<std::array<double, 2>>& places,
                         Dice& dice);
/// The argument of a law in this belt, at a position and the belt's length there.
Site site_of(const BeltFrame& frame, std::size_t belt, const std::array<double, 2>& place,
             double length_mm);

}  // namespace chaintrue::generator
