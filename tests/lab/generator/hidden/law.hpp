// SPDX-License-Identifier: GPL-3.0-or-later
/// \file
/// Laws that no catalogue lists, and fields that are no law: test cases of a law search. Written
/// independently of the product's list.
///
/// A law is a function of one thing (a coordinate of the sheet, a direction across it, one chain's length
/// or angle) or of two, and enters one chain's reading or moves the tool along an axis. A field is a sum
/// of many waves with random directions and phases, whose lengths have the spectrum of its covariance.
#pragma once

#include <string_view>
#include <vector>

#include "generator/hidden/random.hpp"
#include "generator/hidden/strength.hpp"

namespace chaintrue::generator {

enum class LawFamily {
  // of one variable
  step_along_x,
  step_along_y,
  slope_from_x,  ///< level, then rising from a place on
  slope_from_y,
  slope_oblique,
  ripple_of_length,  ///< a wave of one chain's length
  ripple_of_angle,
  ripple_along_x,
  drop_at_edge,  ///< exponential, towards one side of the bed
  // of two, or none
  product_of_two,  ///< of a wave along x and one along y
  gaussian_field,
  matern_field,     ///< of order 3/2: rougher
  stretched_field,  ///< three times as long one way as the other
  uneven_field,     ///< rougher on one side of the bed than on the other
};
std::string_view word(LawFamily family);
/// Its size is a metre's rise.
bool is_slope(LawFamily family);

struct HiddenWave {
  double by_x = 0.0;  ///< radians a mm
  double by_y = 0.0;
  double phase = 0.0;
  double height = 0.0;
};

struct HiddenLaw {
  LawFamily family = LawFamily::step_along_x;
  double size_mm = 1.0;
  bool moves_tool = false;
  std::size_t component = 0;   ///< of the tool: x, y; else the chain or belt that it enters
  std::size_t chain = 0;       ///< whose length or angle it depends on
  double direction_rad = 0.0;  ///< of slope_oblique; of fields that of their longer side
  double place = 0.0;          ///< mm, of a step or the beginning of a slope
  double extent = 0.0;         ///< mm or rad: period, or the length over which a drop falls to 1/e
  double phase = 0.0;
  double sign = 1.0;  ///< of a slope the sense in which it rises, of a drop the side
  std::vector<HiddenWave> waves{};
};

/// The waves of a field, by its extent and direction.
void draw_waves(HiddenLaw& law, Dice& dice);
/// For size 1: a slope per 1000 mm.
double law_value(const HiddenLaw& law, const Site& site);

struct SizedLaw {
  HiddenLaw law;
  /// For the part that no single effect of the catalogue explains.
  double delta = 0.0;
};
/// From 12 to 40, log-uniform.
double drawn_law_strength(Dice& dice);
/// Place, extent, entry and size; the size at most 6 mm, of a slope 12. \throws std::runtime_error if 2000 draws find
/// none.
SizedLaw draw_law(const Yardstick& yardstick, LawFamily family, Dice& dice);
Disturbance disturbance_of(const HiddenLaw& law);

}  // namespace chaintrue::generator
